#include "daemon/request.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace lilo {
namespace {

using nlohmann::json;

struct Kind {
  const char* name;
  RequestKind kind;
};
constexpr std::array<Kind, 5> kKinds{{{"subscribe", RequestKind::subscribe},
                                      {"unsubscribe", RequestKind::unsubscribe},
                                      {"query", RequestKind::query},
                                      {"reset", RequestKind::reset},
                                      {"save", RequestKind::save}}};

ParsedRequest refuse(std::string why) { return {.request = {}, .error = std::move(why)}; }

// The numbers of an object by their names; nothing unless all are there and finite.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(const json& object,
                                             const std::array<const char*, N>& names) {
  std::array<double, N> out{};
  for (std::size_t k = 0; k < N; ++k) {
    if (!object.is_object() || !object.contains(names[k]) || !object[names[k]].is_number())
      return std::nullopt;
    out[k] = object[names[k]].template get<double>();
    if (!std::isfinite(out[k]) || std::abs(out[k]) > 1e7) return std::nullopt;
  }
  return out;
}

std::optional<Pose> pose_from(const json& object) {
  if (!object.is_object()) return std::nullopt;
  const auto p = numbers<3>(object.value("position", json()), {"x", "y", "z"});
  const auto q = numbers<4>(object.value("orientation", json()), {"x", "y", "z", "w"});
  if (!p || !q) return std::nullopt;
  const Eigen::Quaterniond rotation((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3) return std::nullopt;
  return Pose{rotation.normalized(), {(*p)[0], (*p)[1], (*p)[2]}};
}

ParsedRequest read_fields(Request request, const json& body) {
  if (request.kind == RequestKind::query) {
    if (!body.is_string()) return refuse("query: expected \"hello\", \"pose\" or \"health\"");
    request.query = body.get<std::string>();
    return {.request = std::move(request), .error = {}};
  }
  if (request.kind == RequestKind::save) {
    if (body != "map" && body != "trajectory")
      return refuse("save: expected \"map\" or \"trajectory\"");
    request.save = body == "map" ? SaveKind::map : SaveKind::trajectory;
    return {.request = std::move(request), .error = {}};
  }
  if (!body.is_object()) return refuse("expected an object, as in {\"subscribe\":{}}");
  if (body.contains("ttl_s")) {
    const auto ttl = numbers<1>(body, {"ttl_s"});
    if (!ttl) return refuse("ttl_s: expected a number of seconds");
    request.ttl_s = (*ttl)[0];
  }
  for (const auto& [name, wanted] :
       {std::pair{"points", &request.wants.points}, std::pair{"packets", &request.wants.packets}}) {
    if (!body.contains(name)) continue;
    if (!body[name].is_boolean()) return refuse(std::string(name) + ": expected true or false");
    *wanted = body[name].get<bool>();
  }
  if (body.contains("pose")) {
    request.start_pose = pose_from(body["pose"]);
    if (!request.start_pose) return refuse("pose: expected position and unit orientation");
  }
  return {.request = std::move(request), .error = {}};
}

}  // namespace

ParsedRequest parse_request(std::string_view datagram) {
  if (datagram.size() > kMaxRequestBytes) return refuse("expected at most 512 bytes");
  const json object = json::parse(datagram, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return refuse("expected one JSON object");
  Request request;
  const json token = object.value("token", json(""));
  if (!token.is_string()) return refuse("token: expected a string");
  request.token = token.get<std::string>();
  for (const Kind& kind : kKinds) {
    if (!object.contains(kind.name)) continue;
    request.kind = kind.kind;
    return read_fields(std::move(request), object[kind.name]);
  }
  return refuse("expected subscribe, unsubscribe, query, reset or save");
}

}  // namespace lilo
