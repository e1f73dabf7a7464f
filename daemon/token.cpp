// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/token.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <random>

namespace lilo {
namespace {

constexpr std::int64_t kPeriodNs = 30'000'000'000;

struct SipState {
  std::uint64_t v0, v1, v2, v3;

  void round() {
    v0 += v1;
    v1 = std::rotl(v1, 13) ^ v0;
    v0 = std::rotl(v0, 32);
    v2 += v3;
    v3 = std::rotl(v3, 16) ^ v2;
    v0 += v3;
    v3 = std::rotl(v3, 21) ^ v0;
    v2 += v1;
    v1 = std::rotl(v1, 17) ^ v2;
    v2 = std::rotl(v2, 32);
  }
  void absorb(std::uint64_t word) {
    v3 ^= word;
    round();
    round();
    v0 ^= word;
  }
};

// Little-endian, as the paper defines the words; a last one holds the length in its top byte.
std::uint64_t word_at(std::span<const std::byte> bytes) {
  std::uint64_t word = 0;
  for (std::size_t k = 0; k < bytes.size() && k < 8; ++k)
    word |= std::to_integer<std::uint64_t>(bytes[k]) << (8 * k);
  return word;
}

}  // namespace

std::uint64_t siphash(const SipKey& key, std::span<const std::byte> bytes) {
  SipState s{key[0] ^ 0x736f6d6570736575, key[1] ^ 0x646f72616e646f6d, key[0] ^ 0x6c7967656e657261,
             key[1] ^ 0x7465646279746573};
  const std::uint64_t length = bytes.size();
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) s.absorb(word_at(bytes));
  s.absorb(word_at(bytes) | length << 56U);
  s.v2 ^= 0xff;
  for (int k = 0; k < 4; ++k) s.round();
  return s.v0 ^ s.v1 ^ s.v2 ^ s.v3;
}

TokenMaker::TokenMaker() : key_{} {
  std::random_device device;
  for (std::uint64_t& half : key_) half = std::uint64_t{device()} << 32U | device();
}

std::string TokenMaker::of_period(const Requester& who, std::int64_t period) const {
  std::array<std::uint64_t, 4> words{0, 0, who.port, static_cast<std::uint64_t>(period)};
  std::memcpy(words.data(), who.address.data(), who.address.size());
  return fmt::format("{:016x}", siphash(key_, std::as_bytes(std::span(words))));
}

std::string TokenMaker::make(const Requester& who, std::int64_t now_ns) const {
  return of_period(who, now_ns / kPeriodNs);
}

bool TokenMaker::accept(std::string_view token, const Requester& who, std::int64_t now_ns) const {
  const std::int64_t period = now_ns / kPeriodNs;
  return token == of_period(who, period) || token == of_period(who, period - 1);
}

}  // namespace lilo
