//! The check sum of the crate's files, as its documents state it: over words of 64 bits,
//! h ← rotate((h ⊕ word) · 0x100000001b3 mod 2⁶⁴, 23 to the left) from 0xcbf29ce484222325.

pub fn check_sum(words: &[u64]) -> u64 {
    const WORD_RANGE: u128 = 1 << 64;
    let sum = words.iter().fold(0xcbf2_9ce4_8422_2325_u128, |sum, word| {
        let product = (sum ^ u128::from(*word)) * 0x0100_0000_01b3 % WORD_RANGE;
        let shifted_product = product * (1 << 23);
        shifted_product % WORD_RANGE + shifted_product / WORD_RANGE
    });
    u64::try_from(sum).unwrap()
}

/// The words of a text: its length, and its bytes.
pub fn text_words(text: &str) -> Vec<u64> {
    std::iter::once(text.len() as u64).chain(text.bytes().map(u64::from)).collect()
}
