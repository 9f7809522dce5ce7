//! Maps and sums do not depend on the number of threads: the same bits.

use mesh_core::par;

/// Terms of very different size and sign: any other order of addition gives other bits.
fn term(i: usize) -> f64 {
    let x = i as f64 + 0.5;
    (x * 12.9898).sin() * 10f64.powi((i * 7919 % 33) as i32 - 16)
}

const SIZES: [usize; 9] = [0, 1, 255, 256, 1023, 1024, 1025, 5000, 100_003];

#[test]
fn sums_have_the_same_bits_at_any_number_of_threads() {
    for n in SIZES {
        let at = |threads| par::with_threads(threads, || par::sum(n, term)).unwrap().to_bits();
        let one = at(1);
        assert!([2, 3, 4].iter().all(|&threads| at(threads) == one), "{n} terms");
    }
}

#[test]
fn sums_add_up() {
    for n in SIZES {
        assert_eq!(par::sum(n, |i| i as f64), (n * n.saturating_sub(1) / 2) as f64);
    }
    // The test above is sharp: adding these terms backwards gives other bits.
    let backwards: f64 = (0..5000).rev().map(term).sum();
    assert_ne!(backwards.to_bits(), par::sum(5000, term).to_bits());
}

#[test]
fn every_item_is_visited_once() {
    for threads in [1, 2, 4] {
        par::with_threads(threads, || {
            assert_eq!(par::n_threads(), threads);
            for n in SIZES {
                let mut squares = vec![0; n];
                par::fill(&mut squares, |i| i * i);
                assert!(squares.iter().enumerate().all(|(i, &s)| s == i * i));
                par::for_each(&mut squares, |i, s| *s += i);
                assert!(squares.iter().enumerate().all(|(i, &s)| s == i * i + i));
            }
        })
        .unwrap();
    }
}

#[test]
fn lists_are_joined_in_order() {
    // Item i adds i mod 4 numbers.
    let add = |i: usize, list: &mut Vec<(usize, usize)>| list.extend((0..i % 4).map(|k| (i, k)));
    for n in SIZES {
        let mut expected = Vec::new();
        (0..n).for_each(|i| add(i, &mut expected));
        for threads in [1, 2, 4] {
            assert_eq!(par::with_threads(threads, || par::collect(n, add)).unwrap(), expected);
        }
    }
}

#[test]
fn blocks_have_their_own_parts() {
    for n in [0, 1, 7, 8, 9, 1000] {
        let at = |threads| {
            let mut out = vec![0; n];
            let mut firsts = vec![usize::MAX; n.div_ceil(8)];
            let work = || {
                par::blocks(&mut firsts, &mut out, 8, |b, first, part| {
                    *first = b * 8;
                    part.iter_mut().enumerate().for_each(|(k, slot)| *slot = b * 8 + k);
                });
            };
            par::with_threads(threads, work).unwrap();
            (firsts, out)
        };
        let (firsts, out) = at(2);
        assert!(out.iter().enumerate().all(|(i, &slot)| i == slot));
        assert!(firsts.iter().enumerate().all(|(b, &first)| first == b * 8));
        assert_eq!(at(1), (firsts, out));
    }
}
