//! Names of files with a place for a number, as C's `printf` writes it.

/// A name with one place for a number: `%d`, or `%04d` for four digits with zeros in front.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pattern {
    before: String,
    after: String,
    width: usize,
    zeros: bool,
}

/// Most digits that a place may ask for.
const MAX_WIDTH: usize = 20;

impl Pattern {
    /// Reads a pattern; `%%` stands for a percent sign.
    ///
    /// # Errors
    /// A sentence about what is wrong.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let fail = |why: &str| Err(format!("`{text}` is no name with a number: {why}"));
        let (mut parts, mut place) = ([String::new(), String::new()], None);
        let mut rest = text.chars().peekable();
        while let Some(c) = rest.next() {
            let part = &mut parts[usize::from(place.is_some())];
            if c != '%' {
                part.push(c);
                continue;
            }
            if rest.next_if_eq(&'%').is_some() {
                part.push('%');
                continue;
            }
            let zeros = rest.next_if_eq(&'0').is_some();
            let mut width = 0;
            while let Some(digit) = rest.peek().and_then(|c| c.to_digit(10)) {
                width = (10 * width + digit as usize).min(MAX_WIDTH + 1);
                rest.next();
            }
            if !matches!(rest.next(), Some('d' | 'i' | 'u')) {
                return fail("a `%` is followed by something else than `d`, as in `%04d`");
            }
            if width > MAX_WIDTH {
                return fail("it asks for too many digits");
            }
            if place.replace((width, zeros)).is_some() {
                return fail("it has two places for a number");
            }
        }
        let Some((width, zeros)) = place else {
            return fail("it has no place for one, such as `%04d`");
        };
        let [before, after] = parts;
        Ok(Self { before, after, width, zeros })
    }

    /// The name with this number.
    pub(crate) fn name(&self, number: u32) -> String {
        let Self { before, after, width, zeros } = self;
        let width = *width;
        if *zeros {
            format!("{before}{number:0width$}{after}")
        } else {
            format!("{before}{number:width$}{after}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Pattern;

    #[test]
    fn numbers_are_written_as_printf_writes_them() {
        let name = |text, number| Pattern::parse(text).unwrap().name(number);
        assert_eq!(name("a/body%04d.obj", 7), "a/body0007.obj");
        assert_eq!(name("a/body%04d.obj", 12345), "a/body12345.obj");
        assert_eq!(name("%d", 0), "0");
        assert_eq!(name("100%%/%3i", 5), "100%/  5");
        assert_eq!(name("%05u%%é", 42), "00042%é");
    }

    #[test]
    fn other_patterns_are_refused() {
        for (text, why) in [
            ("body.obj", "it has no place for one"),
            ("a%%d", "it has no place for one"),
            ("%d%d", "it has two places"),
            ("%s", "a `%` is followed by"),
            ("%", "a `%` is followed by"),
            ("%04", "a `%` is followed by"),
            ("%99d", "too many digits"),
            ("%99999999999999999999999999999d", "too many digits"),
        ] {
            let error = Pattern::parse(text).unwrap_err();
            assert!(error.contains(why), "{text}: {error}");
        }
    }
}
