// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/allow_list.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

namespace lilo {
namespace {

namespace ip = boost::asio::ip;

bool same_begin(const std::array<std::uint8_t, 16>& a, const std::array<std::uint8_t, 16>& b,
                unsigned bits) {
  const std::size_t whole = bits / 8;
  if (!std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(whole), b.begin()))
    return false;
  const unsigned rest = bits % 8;
  return rest == 0 || (static_cast<unsigned>(a[whole] ^ b[whole]) >> (8U - rest)) == 0;
}

}  // namespace

ip::address unmapped(const ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return ip::make_address_v4(ip::v4_mapped, address.to_v6());
}

AllowList::Range AllowList::single(const ip::address& address) {
  Range range{.v4 = address.is_v4(), .bits = address.is_v4() ? 32U : 128U};
  if (range.v4) {
    const auto bytes = address.to_v4().to_bytes();
    std::copy(bytes.begin(), bytes.end(), range.bytes.begin());
  } else {
    range.bytes = address.to_v6().to_bytes();
  }
  return range;
}

AllowList::Range AllowList::parse(const std::string& text) {
  const std::size_t slash = text.find('/');
  boost::system::error_code error;
  const ip::address address = ip::make_address(text.substr(0, slash), error);
  if (error) throw std::invalid_argument("expected an address or a CIDR range, found " + text);
  Range range = single(unmapped(address));
  if (slash == std::string::npos) return range;
  const char* const end = text.data() + text.size();
  unsigned bits = 0;
  const auto [stopped, failure] = std::from_chars(text.data() + slash + 1, end, bits);
  if (failure != std::errc{} || stopped != end || bits > range.bits)
    throw std::invalid_argument("expected a prefix of at most " + std::to_string(range.bits) +
                                " bits, found " + text);
  range.bits = bits;
  return range;
}

AllowList::AllowList(const std::vector<std::string>& ranges) {
  ranges_.reserve(ranges.size());
  for (const std::string& text : ranges) ranges_.push_back(parse(text));
}

bool AllowList::contains(const ip::address& address) const {
  const Range sought = single(unmapped(address));
  return std::any_of(ranges_.begin(), ranges_.end(), [&](const Range& range) {
    return range.v4 == sought.v4 && same_begin(range.bytes, sought.bytes, range.bits);
  });
}

}  // namespace lilo
