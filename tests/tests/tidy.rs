//! The house rules hold: `cargo xtask tidy` as a test.

use std::path::Path;

#[test]
fn house_rules_hold() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let violations = xtask::tidy::run(&root);
    let list: String = violations.iter().map(|violation| format!("\n{violation}")).collect();
    assert!(violations.is_empty(), "{} violations:{list}", violations.len());
}
