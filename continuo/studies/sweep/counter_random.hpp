// Random bits as a function of a counter and a key: what run number a million draws is known without the draws before.
// Philox4x32-10 of J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3",
// SC '11 (2011), and the mixing function of G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number
// generators", OOPSLA (2014), where bits are needed by the dozen. Internal to sweeps.
#pragma once
#include <array>
#include <cstdint>

namespace continuo::studies::detail {

using PhiloxBlock = std::array<std::uint32_t, 4>;

/// 128 random bits.
[[nodiscard]] constexpr PhiloxBlock philox(PhiloxBlock counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = std::uint64_t{0xD2511F53} * counter[0], second = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
               static_cast<std::uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key = {key[0] + 0x9E3779B9, key[1] + 0xBB67AE85};  // modulo 2^32
  }
  return counter;
}

/// What random bits are for. Each purpose has its own, whatever the other numbers are.
enum class Purpose : std::uint32_t { point, jitter, permutation, scrambling, levels, order };

/// Two times 64 random bits for a purpose: those of number `number` in place `place` under this seed.
[[nodiscard]] constexpr std::array<std::uint64_t, 2> random_bits(std::uint64_t seed, Purpose purpose,
                                                                 std::uint32_t place, std::uint64_t number) {
  const auto bits = philox({static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), place,
                            static_cast<std::uint32_t>(purpose)},
                           {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return {std::uint64_t{bits[0]} << 32 | bits[1], std::uint64_t{bits[2]} << 32 | bits[3]};
}

/// 64 bits, each of which depends on each bit of `number` and of the key.
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t key, std::uint64_t number) {
  std::uint64_t z = key + number * 0x9E3779B97F4A7C15;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
  z = (z ^ z >> 27) * 0x94D049BB133111EB;
  return z ^ z >> 31;
}

/// The high half of a product of 64 by 64 bits: a number below `count` from random bits.
[[nodiscard]] constexpr std::uint64_t below(std::uint64_t count, std::uint64_t bits) {
  const std::uint64_t low = (bits & 0xFFFFFFFF) * (count & 0xFFFFFFFF);
  const std::uint64_t middle = (bits >> 32) * (count & 0xFFFFFFFF) + (low >> 32);
  const std::uint64_t other = (bits & 0xFFFFFFFF) * (count >> 32) + (middle & 0xFFFFFFFF);
  return (bits >> 32) * (count >> 32) + (middle >> 32) + (other >> 32);
}

/// The number of [0, count) to which a permutation of them takes `number`; the key chooses the permutation. Any count:
/// the shuffle "swap or not" of V. T. Hoang, B. Morris, P. Rogaway, "An enciphering scheme based on a card shuffle",
/// CRYPTO (2012). In each round every number has one partner, and whether the two change places is one random bit.
[[nodiscard]] constexpr std::uint64_t permuted(std::uint64_t number, std::uint64_t count, std::uint64_t key) {
  int rounds = 24;
  for (std::uint64_t rest = count; rest > 1; rest /= 2) rounds += 2;
  for (int round = 0; round < rounds; ++round) {
    const std::uint64_t round_key = mixed(key, static_cast<std::uint64_t>(round) + 1);
    const std::uint64_t sum = below(count, round_key);
    const std::uint64_t partner = sum >= number ? sum - number : sum + (count - number);
    const std::uint64_t higher = partner > number ? partner : number;
    if ((mixed(round_key, higher + 1) & 1) != 0) number = partner;
  }
  return number;
}

}  // namespace continuo::studies::detail
