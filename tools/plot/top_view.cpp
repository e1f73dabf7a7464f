// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plot/top_view.hpp"

#include "tools/plot/density_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lilo {
namespace {

constexpr Color kBackground{14, 18, 26};
constexpr Color kBand{22, 28, 38};
constexpr Color kText{232, 236, 241};
constexpr Color kQuietText{150, 160, 174};
constexpr Color kTruth{255, 255, 255};
constexpr std::array<Color, 4> kTracks{
    {{255, 122, 69}, {90, 200, 250}, {190, 140, 255}, {255, 214, 10}}};

/// By TrackingStatus, as `lilo view` colours them.
constexpr std::array<Color, 4> kStatuses{
    {{177, 140, 255}, {53, 196, 111}, {255, 176, 32}, {255, 90, 82}}};
constexpr std::array<const char*, 4> kStatusNames{"initializing", "tracking", "degraded", "lost"};
constexpr Color kMissing{150, 160, 174};

constexpr int kWidth = 1600, kHeader = 96, kFooter = 64, kSide = 32;
constexpr int kLeastHeight = 480, kMostHeight = 960;
constexpr double kLeastMargin_m = 12.0;

/// From metres to pixels of the map area.
struct Projection {
  bool turned = false;  // false: x across, y up; true: y to the left, x up
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double pixels_per_m = 1.0;
  int height = kLeastHeight;

  [[nodiscard]] Eigen::Vector2d operator()(double x_m, double y_m) const {
    const Eigen::Vector2d across_up =
        turned ? Eigen::Vector2d(-y_m, x_m) : Eigen::Vector2d(x_m, y_m);
    const Eigen::Vector2d from_centre = (across_up - centre_m) * pixels_per_m;
    return {kWidth / 2.0 + from_centre.x(), height / 2.0 - from_centre.y()};
  }
};

std::vector<Eigen::Vector3d> all_positions(const TopView& view) {
  std::vector<Eigen::Vector3d> all;
  for (const Track& track : view.tracks) {
    all.insert(all.end(), track.positions_m.begin(), track.positions_m.end());
  }
  if (view.truth) {
    all.insert(all.end(), view.truth->positions_m.begin(), view.truth->positions_m.end());
  }
  if (all.empty()) all.emplace_back(0.0, 0.0, 0.0);
  return all;
}

Projection fit(const TopView& view) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e18), high = -low;
  for (const Eigen::Vector3d& p : all_positions(view)) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  Projection to_pixels;
  Eigen::Vector2d size = high - low, centre = (low + high) / 2.0;
  to_pixels.turned = size.y() > size.x();
  if (to_pixels.turned) {
    size = Eigen::Vector2d(size.y(), size.x());
    centre = Eigen::Vector2d(-centre.y(), centre.x());
  }
  const double margin_m = std::max(kLeastMargin_m, 0.12 * size.x());
  size += Eigen::Vector2d::Constant(2.0 * margin_m);
  to_pixels.centre_m = centre;
  to_pixels.pixels_per_m = std::min(kWidth / size.x(), kMostHeight / size.y());
  to_pixels.height =
      std::clamp(static_cast<int>(size.y() * to_pixels.pixels_per_m), kLeastHeight, kMostHeight);
  return to_pixels;
}

std::vector<Dot> dots_of(const std::vector<Eigen::Vector3f>& points, const Projection& to_pixels) {
  std::vector<Dot> dots;
  dots.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    const Eigen::Vector2d at = to_pixels(p.x(), p.y());
    const bool inside = at.x() >= 0 && at.y() >= 0 && at.x() < kWidth && at.y() < to_pixels.height;
    if (inside) dots.push_back({at.x(), at.y(), p.z()});
  }
  return dots;
}

std::size_t status_at(const Track& track, std::size_t k) {
  return k < track.statuses.size() ? static_cast<std::size_t>(track.statuses[k]) : 0;
}

std::vector<Eigen::Vector2d> points_between(const std::vector<Eigen::Vector2d>& line,
                                            std::size_t first, std::size_t last) {
  const auto begin = line.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, line.begin() + static_cast<std::ptrdiff_t>(last + 1)};
}

/// Where nothing was seen.
void draw_dots(Canvas& canvas, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  constexpr double kEvery = 8.0;  // pixels
  const double length = (to - from).norm();
  for (double at = kEvery; at < length; at += kEvery)
    canvas.disc(from + (to - from) * (at / length), 1.3, kMissing);
}

bool is_by_status(const TopView& view) {
  return view.tracks.size() == 1 && !view.tracks.front().statuses.empty();
}

void draw_track(Canvas& canvas, const Track& track, const Projection& to_pixels, const Color& color,
                double width, bool by_status = false) {
  std::vector<Eigen::Vector2d> line;
  for (const Eigen::Vector3d& p : track.positions_m) {
    line.push_back(to_pixels(p.x(), p.y()) + Eigen::Vector2d(0.0, kHeader));
  }
  // Pieces of one colour without a break; each takes the last point of the one before along.
  std::size_t begin = 0;
  auto next_break = track.breaks.begin();
  for (std::size_t k = 1; k <= line.size(); ++k) {
    const bool breaks = next_break != track.breaks.end() && *next_break == k;
    const bool ends = k == line.size() || breaks || status_at(track, k) != status_at(track, begin);
    if (!ends) continue;
    const std::size_t last = k == line.size() || breaks ? k - 1 : k;
    const Color& piece = by_status ? kStatuses.at(status_at(track, begin)) : color;
    canvas.polyline(points_between(line, begin, last), piece, width);
    if (breaks && k < line.size()) draw_dots(canvas, line[k - 1], line[k]);
    while (next_break != track.breaks.end() && *next_break <= k) ++next_break;
    begin = k;
  }
}

void draw_ends(Canvas& canvas, const Track& track, const Projection& to_pixels,
               const Color& color) {
  if (track.positions_m.empty()) return;
  const auto at = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
    return to_pixels(p.x(), p.y()) + Eigen::Vector2d(0.0, kHeader);
  };
  canvas.disc(at(track.positions_m.front()), 7.0, kBackground);
  canvas.circle(at(track.positions_m.front()), 6.0, color, 2.5);
  canvas.disc(at(track.positions_m.back()), 9.0, kBackground);
  canvas.disc(at(track.positions_m.back()), 7.0, color);
}

/// Entries from right to left, the truth last.
void draw_legend(Canvas& canvas, const TopView& view) {
  double x = kWidth - kSide;
  const double y = 56.0;
  const auto entry = [&](const std::string& name, const Color& color, double width) {
    canvas.text(name, {x, y}, 13.0, kText, Align::right);
    x -= Canvas::text_width(name, 13.0) + 12.0;
    canvas.polyline({{x - 34.0, y - 6.0}, {x, y - 6.0}}, color, width);
    x -= 34.0 + 32.0;
  };
  if (view.truth) entry(view.truth->name, kTruth, 5.0);
  if (is_by_status(view)) {
    const auto& said = view.tracks.front().statuses;
    for (std::size_t k = kStatuses.size(); k-- > 0;) {
      const bool any =
          std::find(said.begin(), said.end(), static_cast<TrackingStatus>(k)) != said.end();
      if (any) entry(kStatusNames.at(k), kStatuses.at(k), 2.5);
    }
    return;
  }
  for (std::size_t k = view.tracks.size(); k-- > 0;) {
    entry(view.tracks[k].name, kTracks.at(k % kTracks.size()), 2.5);
  }
}

void draw_header(Canvas& canvas, const TopView& view) {
  canvas.fill({0, 0, kWidth, kHeader}, kBand);
  const bool two_lines = !view.subtitle.empty();
  canvas.text(view.title, {1.0 * kSide, two_lines ? 42.0 : 58.0}, 19.0, kText, Align::left, true);
  canvas.text(view.subtitle, {1.0 * kSide, 74.0}, 12.5, kQuietText);
  draw_legend(canvas, view);
}

/// 1, 2 or 5 times a power of ten, as long as fits into 240 pixels.
double scale_bar_m(double pixels_per_m) {
  const double most = 240.0 / pixels_per_m;
  const double decade = std::pow(10.0, std::floor(std::log10(most)));
  return decade * (most / decade >= 5.0 ? 5.0 : most / decade >= 2.0 ? 2.0 : 1.0);
}

void draw_scale(Canvas& canvas, double pixels_per_m, double y) {
  const double length_m = scale_bar_m(pixels_per_m);
  const double left = kSide, right = kSide + length_m * pixels_per_m;
  canvas.polyline({{left, y - 7.0}, {left, y}, {right, y}, {right, y - 7.0}}, kText, 2.0);
  canvas.text(fmt::format("{:g} m", length_m), {right + 14.0, y + 2.0}, 13.0, kText);
}

void draw_heights(Canvas& canvas, const std::vector<Dot>& dots, double y) {
  if (dots.empty()) return;
  constexpr int kBar = 220, kBarHeight = 10;
  const auto [low_m, high_m] = height_range_m(dots);
  const std::string high = fmt::format("{:.0f} m", high_m);
  const int right = kWidth - kSide - static_cast<int>(Canvas::text_width(high, 13.0)) - 14;
  for (int k = 0; k < kBar; ++k) {
    const Color color = along(height_colors(), 1.0 * k / (kBar - 1));
    canvas.fill({right - kBar + k, static_cast<int>(y) - kBarHeight, 1, kBarHeight}, color);
  }
  canvas.text(high, {1.0 * kWidth - kSide, y + 2.0}, 13.0, kText, Align::right);
  canvas.text(fmt::format("height  {:.0f} m", low_m), {right - kBar - 14.0, y + 2.0}, 13.0, kText,
              Align::right);
}

/// Of the marks at both ends.
Color end_color(const TopView& view, std::size_t k) {
  if (!is_by_status(view)) return kTracks.at(k % kTracks.size());
  const Track& track = view.tracks[k];
  return kStatuses.at(status_at(track, track.statuses.size() - 1));
}

}  // namespace

Canvas draw(const TopView& view) {
  const Projection to_pixels = fit(view);
  const std::vector<Dot> dots = dots_of(view.points_m, to_pixels);
  Canvas canvas(kWidth, kHeader + to_pixels.height + kFooter, kBand);
  canvas.paste(density_image(kWidth, to_pixels.height, dots, kBackground), 0, kHeader);
  if (view.truth) draw_track(canvas, *view.truth, to_pixels, kTruth, 5.0);
  for (std::size_t k = 0; k < view.tracks.size(); ++k) {
    const Color& color = kTracks.at(k % kTracks.size());
    draw_track(canvas, view.tracks[k], to_pixels, color, 2.5, is_by_status(view));
    draw_ends(canvas, view.tracks[k], to_pixels, end_color(view, k));
  }
  draw_header(canvas, view);
  const double footer_y = kHeader + to_pixels.height + 38.0;
  draw_scale(canvas, to_pixels.pixels_per_m, footer_y);
  draw_heights(canvas, dots, footer_y);
  return canvas;
}

}  // namespace lilo
