// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/key.hpp"

namespace lilo {

bool is_address(std::string_view text);           ///< IPv4
bool is_any_address(std::string_view text);       ///< IPv4 or IPv6
bool is_address_range(std::string_view text);     ///< IPv4 or IPv6, and "/" and a prefix's length
bool is_address_or_empty(std::string_view text);  ///< IPv4 or nothing
bool is_endpoint(std::string_view text);          ///< HOST:PORT, HOST an IPv4 address or localhost
bool is_frame_name(std::string_view text);        ///< 1 to 64 letters, digits, _ - . /
bool is_path(std::string_view text);              ///< no control characters; may be empty

inline constexpr TextForm kAddress{"an IPv4 address", is_address};
inline constexpr TextForm kAnyAddress{"an IPv4 or IPv6 address", is_any_address};
inline constexpr TextForm kAddressRange{
    "an IPv4 or IPv6 address, or a range of them as 192.168.1.0/24", is_address_range};
inline constexpr TextForm kOptionalAddress{"an IPv4 address or \"\"", is_address_or_empty};
inline constexpr TextForm kEndpoint{"HOST:PORT with an IPv4 address or localhost", is_endpoint};
inline constexpr TextForm kFrameName{"a name of 1 to 64 letters, digits, _ - . /", is_frame_name};
inline constexpr TextForm kOptionalPath{"a file name or \"\"", is_path};

}  // namespace lilo
