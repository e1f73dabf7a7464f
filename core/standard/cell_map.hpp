#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

/// The local map: points summed up in small cubic cells of a hash table.
namespace lilo::standard {

/// Symmetric 3x3 matrix: xx xy xz yy yz zz.
using Symmetric = Eigen::Matrix<float, 6, 1>;

template <typename T>
Eigen::Matrix<T, 3, 3> matrix_of(const Eigen::Matrix<T, 6, 1>& s) {
  Eigen::Matrix<T, 3, 3> m;
  m << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return m;
}

/// What the map says about a point near one cell.
struct Match {
  Eigen::Vector3f from_mean_m;             ///< from the mean of the map points around to the point
  const Symmetric* information = nullptr;  ///< 1/m^2; nullptr: the map knows too little there
};

struct CellMapConfig {
  float cell_m = 0.5F;
  float noise_m = 0.02F;  ///< 1 sigma of a return across a surface
  /// Ground: informs of its height and slope only, and not at all where no more than a strip of it
  /// was seen. Where it ends, before a wall or at one ring, moves with the sensor and would hold it
  /// where it is; and of a strip, the foot of the wall would make a slope.
  bool level = false;
  int capacity = 100000;  ///< cells; beyond it new ones are refused and counted
  /// Points a cell remembers; older ones fade. What is seen of a thing moves as the sensor passes
  /// it: held against its oldest views, a scan is dragged back, and every path comes out too short.
  float memory = 30.0F;
};

/// Hash table of cells. A cell's distribution is the Gaussian of the points in the 3x3x3 cells
/// around it. It informs only along directions in which the points are thin against the window: a
/// wall along its normal, a trunk across its axis, foliage hardly at all. What fills its window
/// evenly would only hold the scan where it is (and drag it towards what was seen first).
/// Memory is reserved at construction. Not thread-safe.
class CellMap {
 public:
  struct Index {
    std::int32_t x, y, z;
    bool operator==(const Index&) const = default;
  };
  static constexpr std::int32_t kNone = -1;
  /// A cell's place in the table, whether it is there or not.
  struct Place {
    Index index{};
    std::int32_t last = kNone;  ///< the cell that it was before, if a point has hardly moved
    std::size_t slot = 0;       ///< only where there is no last
  };

  explicit CellMap(const CellMapConfig& config);

  /// Adds a point of the odometry frame. `reach_m`: vector to the next sampled point on the same
  /// surface. The surface between the two was not seen and counts as spread; without it a single
  /// ring on the ground looks like a plane through its own rays, blind to pitch ("cone lock").
  void insert(const Eigen::Vector3d& point_m, const Eigen::Vector3f& reach_m) {
    const Place place = place_of(point_m);
    add(open(place), place, point_m, reach_m);
  }

  /// The distribution around a point. Fits are cached: a young cell is fitted again after every
  /// end_keyframe(), an older one at every sixth at most, and the older the less often.
  Match find(const Eigen::Vector3d& point_m) { return match(cell_at(place_of(point_m)), point_m); }

  /// find() and insert() in steps. Each but the last asks the memory for what the next one reads;
  /// who takes them for many points in turn does not wait for it.
  /// `last`: what cell_at() answered for it before, the map being the same.
  [[nodiscard]] Place place_of(const Eigen::Vector3d& point_m, std::int32_t last = kNone) const;
  [[nodiscard]] std::int32_t cell_at(const Place& place) const;
  Match match(std::int32_t at, const Eigen::Vector3d& point_m);
  /// The cell there, made if missing.
  std::int32_t open(const Place& place);
  void add(std::int32_t at, const Place& place, const Eigen::Vector3d& point_m,
           const Eigen::Vector3f& reach_m);

  void end_keyframe() { ++keyframe_; }

  /// Forgets everything, keeps the memory.
  void clear();

  /// Forgets cells farther than `radius_m` from `center_m`. Every call looks at the same small
  /// share of the table, so that no single scan pays for it.
  void forget_beyond(const Eigen::Vector3d& center_m, double radius_m);

  /// Appends the mean of every cell's own points (m), in no particular order.
  void append_means(std::vector<Eigen::Vector3f>& points_m) const;

  [[nodiscard]] int size() const { return used_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  /// An entry of the hash table. The tag is the index, cut to what differs between cells of one
  /// window of 2048 x 2048 x 1024 cells, so that a cell need not be read to know that it is
  /// another.
  struct Slot {
    std::int32_t at = kNone;  // in cells_ and sums_
    std::uint32_t tag = 0;
  };
  /// What find() reads: one cache line.
  struct alignas(64) Cell {
    Index index{};
    std::uint32_t born = 0;                            // keyframe
    std::uint32_t refit_at = 0;                        // keyframe from which the fit is out of date
    Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();  // from the cell's centre
    Symmetric information = Symmetric::Zero();         // zero: too few points
  };
  /// What insert() sums, from the cell's centre.
  struct Sums {
    float count = 0.0F;
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
    Symmetric square = Symmetric::Zero();
  };

  struct Neighbour {
    std::int32_t at;
    float x_m, y_m, z_m;  // from the one in the middle
  };
  using Neighbours = std::array<Neighbour, 27>;

  [[nodiscard]] Index index_of(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d center_of(const Index& i) const;
  [[nodiscard]] std::size_t slot_of(const Index& i) const;
  [[nodiscard]] static std::uint32_t tag_of(const Index& i);
  /// From one cell to another, the short way round the tags' window.
  [[nodiscard]] static Index between(std::uint32_t from_tag, std::uint32_t to_tag);
  /// From a cell's own slot on, that which holds it, or else the first empty one.
  [[nodiscard]] std::size_t slot_from(std::size_t slot, std::uint32_t tag) const;
  /// Of the 27 cells around and including one, those that are there; how many.
  std::size_t neighbours_of(const Index& i, Neighbours& found) const;
  [[nodiscard]] Sums sums_around(const Index& i) const;
  void fit(Cell& cell) const;
  void remove(std::size_t slot);

  CellMapConfig config_;
  double per_m_;
  float kept_;  // of what a cell remembers, when one more point comes
  std::size_t mask_;
  std::vector<Slot> slots_;
  std::vector<Cell> cells_;
  std::vector<Sums> sums_;
  std::vector<std::int32_t> free_;
  std::size_t sweep_ = 0;
  std::uint32_t keyframe_ = 1;
  int used_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace lilo::standard
