//! SHA-256 as text, by which inputs, scenes and files are told apart.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

/// A hash that grows part by part.
#[derive(Clone, Default)]
pub struct Hash(Sha256);

impl Hash {
    /// Takes more bytes.
    pub fn add(&mut self, bytes: impl AsRef<[u8]>) {
        self.0.update(bytes);
    }

    /// Hexadecimal digits.
    pub fn hex(self) -> String {
        let mut text = String::with_capacity(64);
        for byte in self.0.finalize() {
            write!(text, "{byte:02x}").expect("a String takes everything");
        }
        text
    }
}

/// SHA-256 of bytes in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    let mut hash = Hash::default();
    hash.add(bytes);
    hash.hex()
}

#[cfg(test)]
mod tests {
    /// FIPS 180-2, appendix B.1.
    #[test]
    fn abc() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(super::sha256(b"abc"), expected);
        assert_ne!(super::sha256(b"abd"), expected);
    }
}
