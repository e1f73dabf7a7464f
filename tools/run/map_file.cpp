// SPDX-License-Identifier: BSD-3-Clause
#include "tools/run/map_file.hpp"

#include "tools/plot/canvas.hpp"
#include "tools/plot/density_image.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <utility>

namespace lilo {
namespace {

static_assert(std::endian::native == std::endian::little, "both files are");

bool is_ply(const std::string& path) { return path.ends_with(".ply"); }

std::pair<float, float> height_span_m(const std::vector<MapPoint>& points) {
  std::vector<float> heights;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 100'000);
  for (std::size_t k = 0; k < points.size(); k += step) heights.push_back(points[k].position_m.z());
  if (heights.empty()) return {0.0F, 1.0F};
  std::sort(heights.begin(), heights.end());
  const float low = heights[heights.size() / 100], high = heights[heights.size() * 99 / 100];
  return {low, std::max(high, low + 0.1F)};
}

/// Intensities of most surfaces are low: the root spreads them.
double of_intensity(std::uint8_t intensity) { return std::sqrt(intensity / 255.0); }

std::string ply_header(std::size_t points) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment lilo " LILO_VERSION
      ", metres, odometry frame\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar intensity\n"
      "end_header\n",
      points);
}

/// The colour as PCL packs it: 0x00RRGGBB in an integer field called rgb.
std::string pcd_header(std::size_t points) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n"
      "VERSION 0.7\nFIELDS x y z rgb intensity\nSIZE 4 4 4 4 4\nTYPE F F F U F\nCOUNT 1 1 1 1 1\n"
      "WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points);
}

template <typename T>
void append(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_point(const MapPoint& point, const Color& color, bool ply, std::string& out) {
  for (int axis = 0; axis < 3; ++axis) append(out, point.position_m[axis]);
  if (ply) {
    for (const int channel : {color.r, color.g, color.b}) out += static_cast<char>(channel);
    append(out, point.intensity);
  } else {
    append(out, static_cast<std::uint32_t>(color.r << 16 | color.g << 8 | color.b));
    append(out, static_cast<float>(point.intensity));
  }
}

}  // namespace

bool is_map_file(const std::string& path) { return is_ply(path) || path.ends_with(".pcd"); }

void write_map(const std::string& path, const std::vector<MapPoint>& points, MapColor color) {
  const bool ply = is_ply(path);
  const auto [low_m, high_m] = height_span_m(points);
  std::ofstream file = create_text(path);
  file << (ply ? ply_header(points.size()) : pcd_header(points.size()));
  std::string bytes;
  for (const MapPoint& point : points) {
    const double s = color == MapColor::intensity
                         ? of_intensity(point.intensity)
                         : static_cast<double>((point.position_m.z() - low_m) / (high_m - low_m));
    append_point(point, along(height_colors(), s), ply, bytes);
    if (bytes.size() < (1U << 20U)) continue;
    file << bytes;
    bytes.clear();
  }
  file << bytes;
  finish_text(file, path);
}

}  // namespace lilo
