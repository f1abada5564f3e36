//! The check sum of all files: convolution weights, checkpoints, rows of sweeps.

/// A check sum of 64-bit words (FNV-1a, rotated after each word).
///
/// A change within one word always changes the sum; any other damage changes it almost certainly.
#[derive(Debug, Clone, Copy)]
pub struct CheckSum(u64);

impl Default for CheckSum {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl CheckSum {
    pub fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23);
    }

    pub fn add_number(&mut self, number: f64) {
        self.add(number.to_bits());
    }

    /// Adds the length of a list and its entries, so that no entry can move to the next list.
    pub fn add_list(&mut self, words: impl ExactSizeIterator<Item = u64>) {
        self.add(words.len() as u64);
        for word in words {
            self.add(word);
        }
    }

    pub fn add_numbers(&mut self, numbers: &[f64]) {
        self.add_list(numbers.iter().map(|number| number.to_bits()));
    }

    /// Adds a text by its bytes.
    pub fn add_text(&mut self, text: &str) {
        self.add_list(text.bytes().map(u64::from));
    }

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

    fn sum(words: &[u64]) -> u64 {
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
        let whole = sum(&words);
        for place in 0..words.len() {
            for bit in 0..64 {
                let mut other = words;
                other[place] ^= 1 << bit;
                assert_ne!(sum(&other), whole, "bit {bit} of word {place}");
            }
            let mut swapped = words;
            swapped.swap(place, (place + 1) % words.len());
            assert!(sum(&swapped) != whole || swapped == words, "{place}");
        }
        assert_ne!(sum(&words[..4]), whole);
    }

    #[test]
    fn lists_and_texts_keep_their_ends() {
        assert_ne!(sum_of_texts(&["ab", "c"]), sum_of_texts(&["a", "bc"]));
        assert_ne!(sum_of_texts(&["", "a"]), sum_of_texts(&["a", ""]));
        assert_eq!(sum_of_texts(&[]), "cbf29ce484222325");
    }
}
