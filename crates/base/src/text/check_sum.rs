//! Check sum of stored files: convolution weights, checkpoints, rows of sweeps.

/// Check sum of 64-bit words (FNV-1a, rotated after each word).
///
/// A change within one word always changes the sum; any other damage changes the sum almost certainly.
#[derive(Debug, Clone, Copy)]
pub struct CheckSum(u64);

/// Start value of FNV-1a for 64 bits.
const FNV_OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
/// Factor of FNV-1a for 64 bits.
const FNV_PRIME: u64 = 0x0000_0100_0000_01b3;
/// Number of bits by which the sum is rotated after each word.
///
/// A product carries changes of bits only to higher bits; the rotation returns them to low bits.
const ROTATED_BITS: u32 = 23;

impl Default for CheckSum {
    fn default() -> Self {
        Self(FNV_OFFSET_BASIS)
    }
}

impl CheckSum {
    /// Adds a word.
    pub fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(FNV_PRIME).rotate_left(ROTATED_BITS);
    }

    /// Adds a number by its bits.
    pub fn add_number(&mut self, number: f64) {
        self.add(number.to_bits());
    }

    /// Adds the length and the entries of a list.
    ///
    /// The sum therefore depends on where one list ends.
    pub fn add_list(&mut self, words: impl ExactSizeIterator<Item = u64>) {
        self.add(words.len() as u64);
        for word in words {
            self.add(word);
        }
    }

    /// Adds a list of numbers by their bits.
    pub fn add_numbers(&mut self, numbers: &[f64]) {
        self.add_list(numbers.iter().map(|number| number.to_bits()));
    }

    /// Adds a text by its bytes.
    pub fn add_text(&mut self, text: &str) {
        self.add_list(text.bytes().map(u64::from));
    }

    /// The sum of all words so far.
    pub fn value(self) -> u64 {
        self.0
    }

    /// Check sum as sixteen hexadecimal digits.
    pub fn text(self) -> String {
        format!("{:016x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum_of_words(words: &[u64]) -> u64 {
        let mut sum = CheckSum::default();
        for word in words {
            sum.add(*word);
        }
        sum.value()
    }

    fn sum_of_texts(texts: &[&str]) -> String {
        let mut sum = CheckSum::default();
        for text in texts {
            sum.add_text(text);
        }
        sum.text()
    }

    #[test]
    fn every_bit_of_every_word_counts() {
        let words = [0, 1, u64::MAX, 0x3ff0_0000_0000_0000, 0];
        let expected = sum_of_words(&words);
        for index in 0..words.len() {
            for bit in 0..64 {
                let mut changed_words = words;
                changed_words[index] ^= 1 << bit;
                assert_ne!(sum_of_words(&changed_words), expected, "bit {bit} of word {index}");
            }
            let mut swapped_words = words;
            swapped_words.swap(index, (index + 1) % words.len());
            assert!(
                sum_of_words(&swapped_words) != expected || swapped_words == words,
                "word {index}"
            );
        }
        assert_ne!(sum_of_words(&words[..4]), expected);
    }

    #[test]
    fn lists_and_texts_keep_their_ends() {
        assert_ne!(sum_of_texts(&["ab", "c"]), sum_of_texts(&["a", "bc"]));
        assert_ne!(sum_of_texts(&["", "a"]), sum_of_texts(&["a", ""]));
        assert_eq!(sum_of_texts(&[]), "cbf29ce484222325");
    }
}
