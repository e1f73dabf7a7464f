// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// What libFuzzer calls; replay_corpus.cpp calls it for every file of a folder instead.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace lilo::fuzz {

inline std::span<const std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}

/// Ends the program: a promise was broken.
inline void require(bool holds) {
  if (!holds) __builtin_trap();
}

}  // namespace lilo::fuzz
