//! The check sum of the crate's files, as its documents state it: over words of 64 bits,
//! h ← rotate((h ⊕ word) · 0x100000001b3 mod 2⁶⁴, 23 to the left) from 0xcbf29ce484222325.

pub(crate) fn check_sum(words: &[u64]) -> u64 {
    words.iter().fold(0xcbf2_9ce4_8422_2325_u64, |sum, word| {
        let product = u128::from(sum ^ word) * 0x0100_0000_01b3;
        let low = (product & u128::from(u64::MAX)) as u64;
        low << 23 | low >> 41
    })
}

/// The words of a text: its length, and its bytes.
pub(crate) fn text_words(text: &str) -> Vec<u64> {
    std::iter::once(text.len() as u64).chain(text.bytes().map(u64::from)).collect()
}
