// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/json_writer.hpp"

#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>

namespace lilo {
namespace {

/// A number in print; empty when it has more digits than any number we mean.
struct Digits {
  std::array<char, 64> bytes{};
  std::size_t size = 0;

  template <typename... Form>
  explicit Digits(Form... form) {
    const auto [end, error] = std::to_chars(bytes.data(), bytes.data() + bytes.size(), form...);
    if (error == std::errc{}) size = static_cast<std::size_t>(end - bytes.data());
  }
  [[nodiscard]] std::string_view view() const { return {bytes.data(), size}; }
};

// Without the zeros at its end, of "1.250000" or "3.000000".
std::string_view trimmed(std::string_view text) {
  if (text.find('.') == std::string_view::npos) return text;
  text = text.substr(0, text.find_last_not_of('0') + 1);
  return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
}

}  // namespace

void JsonWriter::put(char c) { put(std::string_view(&c, 1)); }

void JsonWriter::put(std::string_view text) {
  if (!fits_ || size_ + text.size() > buffer_.size()) {
    fits_ = false;
    return;
  }
  std::memcpy(buffer_.data() + size_, text.data(), text.size());
  size_ += text.size();
}

void JsonWriter::quoted(std::string_view text) {
  put('"');
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      put('\\');
      put(c);
    } else if (byte < 0x20) {
      put("\\u00");
      put("0123456789abcdef"[byte >> 4U]);
      put("0123456789abcdef"[byte & 15U]);
    } else {
      put(byte < 0x7f ? c : '?');
    }
  }
  put('"');
}

void JsonWriter::key(std::string_view name) {
  if (!first_) put(',');
  first_ = false;
  if (name.empty()) return;
  quoted(name);
  put(':');
}

void JsonWriter::begin_object(std::string_view name) {
  key(name);
  put('{');
  first_ = true;
}

void JsonWriter::end_object() {
  put('}');
  first_ = false;
}

void JsonWriter::begin_array(std::string_view name) {
  key(name);
  put('[');
  first_ = true;
}

void JsonWriter::end_array() {
  put(']');
  first_ = false;
}

void JsonWriter::number(std::string_view name, double value, int decimals) {
  if (!std::isfinite(value)) return;
  const Digits d(value, std::chars_format::fixed, decimals);
  if (d.size == 0) fits_ = false;  // 1e60 and the like
  key(name);
  put(trimmed(d.view()));
}

void JsonWriter::scientific(double value) {
  key("");
  put(std::isfinite(value) ? Digits(value, std::chars_format::general, 4).view() : "null");
}

void JsonWriter::integer(std::string_view name, std::int64_t value) {
  key(name);
  put(Digits(value).view());
}

void JsonWriter::unsigned_integer(std::string_view name, std::uint64_t value) {
  key(name);
  put(Digits(value).view());
}

void JsonWriter::boolean(std::string_view name, bool value) {
  key(name);
  put(value ? "true" : "false");
}

void JsonWriter::text(std::string_view name, std::string_view value) {
  key(name);
  quoted(value);
}

void JsonWriter::item(std::string_view value) {
  key("");
  quoted(value);
}

void JsonWriter::seconds(std::string_view name, std::int64_t ns) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  const auto bits = static_cast<std::uint64_t>(ns);
  const std::uint64_t magnitude = ns < 0 ? ~bits + 1 : bits;
  key(name);
  if (ns < 0) put('-');
  put(Digits(magnitude / kSecond).view());
  // 1.nnnnnnnnn without its first digit: the nanoseconds with their leading zeros.
  const Digits fraction(kSecond + magnitude % kSecond);
  std::array<char, 10> point_and_digits{};
  std::memcpy(point_and_digits.data(), fraction.bytes.data(), point_and_digits.size());
  point_and_digits[0] = '.';
  put(trimmed({point_and_digits.data(), point_and_digits.size()}));
}

std::string_view JsonWriter::finish() {
  put('}');
  return fits_ ? std::string_view(buffer_.data(), size_) : std::string_view();
}

}  // namespace lilo
