// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/run/voxel_map.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lilo {

/// What the colour of a point tells.
enum class MapColor : std::uint8_t { height, intensity };

/// Whether a map can be written to a file of this name: it ends in .ply or .pcd.
bool is_map_file(const std::string& path);

/// Writes binary PLY or PCD by the file's ending: x, y, z (m, float), colour, intensity. Heights
/// are coloured between the lowest and the highest hundredth. Throws std::runtime_error.
void write_map(const std::string& path, const std::vector<MapPoint>& points, MapColor color);

}  // namespace lilo
