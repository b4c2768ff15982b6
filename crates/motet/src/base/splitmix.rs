//! Numbers that look random and are the same on every run.

/// A number of which every bit depends on every bit of `x`: the output of splitmix64 for the state `x`
/// (Steele, Lea and Flood 2014, *Fast splittable pseudorandom number generators*). Different `x` give
/// different numbers.
#[inline]
pub(crate) fn splitmix64(x: u64) -> u64 {
    let z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

#[cfg(test)]
mod tests {
    use super::splitmix64;

    #[test]
    fn it_is_splitmix64() {
        // The first numbers of the generator from the seed 1234567, as published with it.
        let state = |i: u64| 1_234_567u64.wrapping_add(i.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let first: Vec<u64> = (0..3).map(|i| splitmix64(state(i))).collect();
        assert_eq!(first, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }
}
