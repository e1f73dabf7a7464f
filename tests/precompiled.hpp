// SPDX-License-Identifier: BSD-3-Clause
/// What most tests include, read once by the compiler (LILO_PRECOMPILE). Every test includes what
/// it uses all the same: clang-tidy and builds without the option see no precompiled header. Only
/// headers whose macros do not depend on what a target links.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>
