// SPDX-License-Identifier: BSD-3-Clause
// How long each kernel of the odometry takes for one scan: a VLP-16 or an HDL-64E in a hall of
// 40 x 24 x 8 m with a row of pillars, made here. See README.md.
#include "core/image/feature_image.hpp"
#include "core/image/selection.hpp"
#include "core/paper/features.hpp"
#include "core/paper/range_image.hpp"
#include "core/paper/registration.hpp"
#include "core/paper/segmentation.hpp"
#include "core/registration/solver.hpp"
#include "core/search/displacement_search.hpp"
#include "core/search/top_down_grid.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace {

using namespace lilo;  // NOLINT(google-build-using-namespace)

constexpr double kMinRange_m = 1.0, kMaxRange_m = 100.0;
constexpr std::int64_t kTurn_ns = 100'000'000;

// Range to the hall's walls, floor 1.9 m below, ceiling, or to a pillar of 0.4 m every 5 m.
double range_to_hall(double x, double y, double z) {
  double range = std::min(20.0 / std::max(std::abs(x), 1e-9), 12.0 / std::max(std::abs(y), 1e-9));
  if (z != 0.0) range = std::min(range, (z < 0.0 ? 1.9 : 6.1) / std::abs(z));
  for (const double side : {-6.0, 6.0})
    for (double along = -17.5; along < 20.0; along += 5.0) {
      const double flat2 = x * x + y * y, middle = (x * along + y * side) / flat2;
      const double away2 = along * along + side * side - middle * middle * flat2;
      if (middle > 0.0 && away2 < 0.04)
        range = std::min(range, middle - std::sqrt((0.04 - away2) / flat2));
    }
  return range;
}

Scan hall_scan(int rings) {
  Scan scan;
  const double low = rings == 16 ? -15.0 : -24.8, high = rings == 16 ? 15.0 : 2.0;
  const int columns = rings == 16 ? 1808 : 2083;
  scan.end_ns = kTurn_ns;
  scan.complete = true;
  scan.beams.ring_count = rings;
  for (int ring = 0; ring < rings; ++ring)
    scan.beams.elevation_rad[static_cast<std::size_t>(ring)] =
        static_cast<float>((low + (high - low) * ring / (rings - 1)) * std::numbers::pi / 180.0);
  for (int column = 0; column < columns; ++column) {
    const double azimuth = std::numbers::pi - 2.0 * std::numbers::pi * (column + 0.5) / columns;
    for (int ring = 0; ring < rings; ++ring) {
      const auto w = static_cast<double>(scan.beams.elevation_rad[static_cast<std::size_t>(ring)]);
      const double x = std::cos(w) * std::cos(azimuth), y = std::cos(w) * std::sin(azimuth);
      const double range = range_to_hall(x, y, std::sin(w));
      scan.returns.push_back({.x_m = static_cast<float>(range * x),
                              .y_m = static_cast<float>(range * y),
                              .z_m = static_cast<float>(range * std::sin(w)),
                              .azimuth_rad = static_cast<float>(azimuth),
                              .t_ns = static_cast<std::int32_t>(kTurn_ns * column / columns),
                              .ring = static_cast<std::uint8_t>(ring),
                              .intensity = 50,
                              .kind = ReturnKind::strongest});
    }
  }
  return scan;
}

int rings_of(const benchmark::State& state) { return static_cast<int>(state.range(0)); }

// Projection and classification, which the class does in one call.
void image_features(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  core::FeatureImage image(1024, {});
  for (auto _ : state) benchmark::DoNotOptimize(image.build(scan).size());
}

void selection(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  core::FeatureImage image(1024, {});
  const auto& all = image.build(scan);
  core::Selection chosen(1200, 1500);
  for (auto _ : state) benchmark::DoNotOptimize(chosen.choose(all).size());
}

// One turn and the 25 speeds that share it, as in the search for the motion at the start.
void top_down_grid(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  core::FeatureImage image(1024, {});
  core::Selection chosen(1200, 1500);
  core::StructurePoints outline;
  outline.assign(chosen.choose(image.build(scan)));
  core::TopDownPoints plan;
  core::TopDownGrid laid(chosen.most());
  const Eigen::Quaterniond ahead = Eigen::Quaterniond::Identity();
  for (auto _ : state) {
    plan.assign(outline, ahead, ahead, core::Subsample::all);
    for (int speed = 0; speed < 25; ++speed) {
      laid.clear();
      laid.add(plan, {0.0, 0.0}, {0.1 * speed, 0.0});
      benchmark::DoNotOptimize(laid.occupied());
    }
  }
  state.SetItemsProcessed(state.iterations() * 25 * static_cast<std::int64_t>(outline.s.size()));
}

core::CellMap empty_map(float cell_m) {
  return core::CellMap({.cell_m = cell_m, .capacity = 120'000});
}

Eigen::Vector3d position_of(const Feature& f) {
  return Eigen::Vector3f(f.x_m, f.y_m, f.z_m).cast<double>();
}

void fill(core::CellMap& map, const std::vector<Feature>& features) {
  for (const Feature& f : features) map.insert(position_of(f), {f.dx_m, f.dy_m, f.dz_m});
}

// As far as it ever looks, the map being drawn already.
void displacement_search(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  core::FeatureImage image(1024, {});
  const auto& features = image.build(scan);
  core::CellMap map = empty_map(1.5F);
  fill(map, features);
  core::Selection chosen(1200, 1500);
  const auto& asked = chosen.choose(features);
  core::Trajectory standing;
  standing.knots = core::Unknowns::Zero(Eigen::Index{core::kKnotSize} * 2);
  core::DisplacementSearch search(chosen.most());
  search.set_map(map, Eigen::Vector3d::Zero());
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        search.find(asked, standing, core::DisplacementSearch::kFarthest).data());
  }
}

void cell_map_insert(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  core::FeatureImage image(1024, {});
  const auto& features = image.build(scan);
  core::CellMap map = empty_map(0.5F);
  for (auto _ : state) {
    fill(map, features);
    state.PauseTiming();
    map.clear();
    state.ResumeTiming();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(features.size()));
}

// Fits are in the cache, as for most points of a scan.
void cell_map_find(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  core::FeatureImage image(1024, {});
  const auto& features = image.build(scan);
  core::CellMap map = empty_map(0.5F);
  fill(map, features);
  for (auto _ : state)
    for (const Feature& f : features)
      benchmark::DoNotOptimize(map.find(position_of(f)).information);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(features.size()));
}

// One Gauss-Newton round on selected features, the sensor at rest.
void solver_round(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  core::FeatureImage image(1024, {});
  const auto& all = image.build(scan);
  const auto level = [](float cell_m) {
    const core::CellMapConfig config{.cell_m = cell_m, .capacity = 100000};
    return std::array{config, config};
  };
  core::LocalMaps maps({level(0.25F), level(0.5F), level(1.5F)});
  std::vector<core::LocalMaps::Point> points;
  points.reserve(all.size());
  for (const Feature& f : all) {
    points.push_back({position_of(f), {f.dx_m, f.dy_m, f.dz_m}, f.kind});
  }
  maps.insert(points, core::LocalMaps::kWhole);
  core::Selection selection(1200, 1500);
  const auto& chosen = selection.choose(all);
  core::Solver solver({.max_iterations = 1}, 4096);
  int matched = 0;
  for (auto _ : state) matched = solver.solve(chosen, maps, {}).matched;
  state.counters["matched"] = matched;
}

paper::RangeImage paper_image(const Scan& scan) {
  paper::RangeImage image;
  paper::project(scan, 720, kMinRange_m, kMaxRange_m, image);
  return image;
}

void paper_projection(benchmark::State& state) {
  const Scan scan = hall_scan(rings_of(state));
  paper::RangeImage image;
  for (auto _ : state) paper::project(scan, 720, kMinRange_m, kMaxRange_m, image);
}

void paper_sobel(benchmark::State& state) {
  const auto image = paper_image(hall_scan(rings_of(state)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(paper::horizontal_sobel(image.range_m).data);
    benchmark::DoNotOptimize(paper::vertical_sobel(image.range_m).data);
  }
}

void paper_fourier_mask(benchmark::State& state) {
  const auto image = paper_image(hall_scan(rings_of(state)));
  for (auto _ : state) benchmark::DoNotOptimize(paper::fourier_filter(image.range_m).data);
}

paper::Features paper_features(const Scan& scan) {
  const auto image = paper_image(scan);
  return paper::reconstruct(scan, image, paper::segment(image.range_m, {}, scan.beams));
}

void paper_voxel_grid(benchmark::State& state) {
  const auto features = paper_features(hall_scan(rings_of(state)));
  for (auto _ : state) benchmark::DoNotOptimize(paper::voxel_grid(features.surfaces, 0.8)->size());
}

// One step of Eq. 20: neighbours, lines and planes for all features, and the normal equation.
void paper_correspondences(benchmark::State& state) {
  const auto features = paper_features(hall_scan(rings_of(state)));
  const auto edges = paper::voxel_grid(features.edges, 0.4);
  const auto surfaces = paper::voxel_grid(features.surfaces, 0.8);
  paper::LocalMap edge_map(0.4, 100.0), surface_map(0.8, 100.0);
  edge_map.update({edges.get()}, {});
  surface_map.update({surfaces.get()}, {});
  PaperConfig config;
  config.max_iterations = 1;
  int found = 0;
  for (auto _ : state) {
    std::int64_t left = std::numeric_limits<std::int64_t>::max();
    found = paper::align(*edges, *surfaces, edge_map, surface_map, {}, 1.0, config, left)
                .correspondences;
  }
  state.counters["correspondences"] = found;
}

#define LILO_KERNEL(name) BENCHMARK(name)->Arg(16)->Arg(64)->Unit(benchmark::kMicrosecond)
LILO_KERNEL(image_features);
LILO_KERNEL(selection);
LILO_KERNEL(top_down_grid);
LILO_KERNEL(displacement_search);
LILO_KERNEL(cell_map_insert);
LILO_KERNEL(cell_map_find);
LILO_KERNEL(solver_round);
LILO_KERNEL(paper_projection);
LILO_KERNEL(paper_sobel);
LILO_KERNEL(paper_fourier_mask);
LILO_KERNEL(paper_voxel_grid);
LILO_KERNEL(paper_correspondences);

}  // namespace

BENCHMARK_MAIN();
