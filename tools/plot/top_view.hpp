// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/estimate.hpp"
#include "tools/plot/canvas.hpp"

#include <optional>
#include <string>
#include <vector>

namespace lilo {

/// A trajectory on the map. All are told in one frame.
struct Track {
  std::string name;
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<std::size_t> breaks;       ///< positions before which some are missing, ascending
  std::vector<TrackingStatus> statuses;  ///< of each position; empty: not known
};

/// A picture of what was driven, seen from above. A track that is alone and knows its statuses is
/// coloured by them; where poses are missing, a track is dotted.
struct TopView {
  std::string title, subtitle;
  std::vector<Track> tracks;
  std::optional<Track> truth;  ///< drawn under the tracks
  std::vector<Eigen::Vector3f> points_m;
};

/// Draws it: header with title and legend, the map, a footer with scale and heights. The longer
/// side of the way lies across. A view without any position gives an empty map.
Canvas draw(const TopView& view);

}  // namespace lilo
