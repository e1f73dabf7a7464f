// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/points_message.hpp"

#include "daemon/message_head.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lilo {
namespace {

constexpr std::size_t kBase64PerPoint = 8;  // of 3 x 16 bits: never any padding
constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

bool is_representable(const Eigen::Vector3f& p_m) {
  constexpr float kFarthest_m = 32767.0F * static_cast<float>(kPointResolution_m);
  return p_m.allFinite() && p_m.cwiseAbs().maxCoeff() <= kFarthest_m;
}

/// x, y, z as little-endian 16-bit integers, the bytes as base64 (RFC 4648).
void encode(const Eigen::Vector3f& p_m, char* out) {
  std::uint64_t bytes = 0;  // the first byte on top
  for (int axis = 0; axis < 3; ++axis) {
    const auto steps =
        static_cast<std::int16_t>(std::lround(static_cast<double>(p_m[axis]) / kPointResolution_m));
    const auto bits = static_cast<std::uint16_t>(steps);
    bytes = bytes << 16U | (bits & 0xFFU) << 8U | bits >> 8U;
  }
  for (std::size_t k = 0; k < kBase64PerPoint; ++k) out[k] = kBase64[bytes >> (42 - 6 * k) & 63U];
}

}  // namespace

std::string_view write_points(const PointsContext& context, PointSet set,
                              std::span<const Eigen::Vector3f> all_m, std::size_t index,
                              JsonWriter& out) {
  const std::size_t first = std::min(index * kPointsPerDatagram, all_m.size());
  const std::size_t count = std::min(kPointsPerDatagram, all_m.size() - first);
  std::array<char, kPointsPerDatagram * kBase64PerPoint> text{};
  std::size_t size = 0;
  for (const Eigen::Vector3f& p_m : all_m.subspan(first, count)) {
    if (!is_representable(p_m)) continue;
    encode(p_m, text.data() + size);
    size += kBase64PerPoint;
  }
  begin_message(out, context.stamp_ns, context.session);
  out.unsigned_integer("seq", context.seq);
  out.begin_object("points");
  out.text("of", set == PointSet::scan ? "scan" : "map");
  out.unsigned_integer("index", index);
  out.unsigned_integer("count", points_datagrams(all_m.size()));
  out.number("resolution_m", kPointResolution_m, 3);
  out.text("xyz", {text.data(), size});
  out.end_object();
  return out.finish();
}

}  // namespace lilo
