// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/request.hpp"

#include <rapidjson/document.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace lilo {
namespace {

// What a request needs lies in these bytes of the stack: a subscriber who renews costs no
// allocation. What needs more, as 500 brackets do, takes it from the heap.
constexpr std::size_t kTreeBytes = 8192, kStackBytes = 4096;
using Memory = rapidjson::MemoryPoolAllocator<>;
using Document = rapidjson::GenericDocument<rapidjson::UTF8<>, Memory, Memory>;
using Json = Document::ValueType;

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

/// nullptr: `object` has no such member, or is none.
const Json* member(const Json& object, const char* name) {
  if (!object.IsObject()) return nullptr;
  const auto found = object.FindMember(name);
  return found == object.MemberEnd() ? nullptr : &found->value;
}

std::string_view text_of(const Json& value) {
  return value.IsString() ? std::string_view(value.GetString(), value.GetStringLength())
                          : std::string_view();
}

// The numbers of an object by their names; nothing unless all are there and within 1e7.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(const Json* object,
                                             const std::array<const char*, N>& names) {
  if (object == nullptr) return std::nullopt;
  std::array<double, N> out{};
  for (std::size_t k = 0; k < N; ++k) {
    const Json* number = member(*object, names[k]);
    if (number == nullptr || !number->IsNumber()) return std::nullopt;
    out[k] = number->GetDouble();
    if (!(std::abs(out[k]) <= 1e7)) return std::nullopt;
  }
  return out;
}

std::optional<Pose> pose_from(const Json& object) {
  const auto p = numbers<3>(member(object, "position"), {"x", "y", "z"});
  const auto q = numbers<4>(member(object, "orientation"), {"x", "y", "z", "w"});
  if (!p || !q) return std::nullopt;
  const Eigen::Quaterniond rotation((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3) return std::nullopt;
  return Pose{rotation.normalized(), {(*p)[0], (*p)[1], (*p)[2]}};
}

ParsedRequest accept(Request request) { return {.request = std::move(request), .error = {}}; }

ParsedRequest read_save(Request request, const Json& body) {
  const std::string_view what = text_of(body);
  if (what != "map" && what != "trajectory")
    return refuse("save: expected \"map\" or \"trajectory\"");
  request.save = what == "map" ? SaveKind::map : SaveKind::trajectory;
  return accept(std::move(request));
}

ParsedRequest read_query(Request request, const Json& body) {
  if (!body.IsString()) return refuse("query: expected \"hello\", \"pose\" or \"health\"");
  request.query = text_of(body);
  return accept(std::move(request));
}

ParsedRequest read_object(Request request, const Json& body) {
  if (!body.IsObject()) return refuse("expected an object, as in {\"subscribe\":{}}");
  if (member(body, "ttl_s") != nullptr) {
    const auto ttl = numbers<1>(&body, {"ttl_s"});
    if (!ttl) return refuse("ttl_s: expected a number of seconds");
    request.ttl_s = (*ttl)[0];
  }
  for (const auto& [name, wanted] :
       {std::pair{"points", &request.wants.points}, std::pair{"packets", &request.wants.packets}}) {
    const Json* asked = member(body, name);
    if (asked == nullptr) continue;
    if (!asked->IsBool()) return refuse(std::string(name) + ": expected true or false");
    *wanted = asked->GetBool();
  }
  if (const Json* pose = member(body, "pose")) {
    request.start_pose = pose_from(*pose);
    if (!request.start_pose) return refuse("pose: expected position and unit orientation");
  }
  return accept(std::move(request));
}

ParsedRequest read_fields(Request request, const Json& body) {
  switch (request.kind) {
    case RequestKind::query:
      return read_query(std::move(request), body);
    case RequestKind::save:
      return read_save(std::move(request), body);
    case RequestKind::subscribe:
    case RequestKind::unsubscribe:
    case RequestKind::reset:
      break;
  }
  return read_object(std::move(request), body);
}

}  // namespace

ParsedRequest parse_request(std::string_view datagram) {
  if (datagram.size() > kMaxRequestBytes) return refuse("expected at most 512 bytes");
  alignas(std::max_align_t) std::array<char, kTreeBytes> tree_bytes{};
  alignas(std::max_align_t) std::array<char, kStackBytes> stack_bytes{};
  Memory tree(tree_bytes.data(), tree_bytes.size());
  Memory stack(stack_bytes.data(), stack_bytes.size());
  Document object(&tree, kStackBytes / 2, &stack);
  // Iterative: depth of nesting takes no call stack.
  constexpr unsigned kStrictly =
      rapidjson::kParseIterativeFlag | rapidjson::kParseValidateEncodingFlag;
  object.Parse<kStrictly>(datagram.data(), datagram.size());
  if (object.HasParseError() || !object.IsObject()) return refuse("expected one JSON object");
  Request request;
  if (const Json* token = member(object, "token")) {
    if (!token->IsString()) return refuse("token: expected a string");
    request.token = text_of(*token);
  }
  for (const Kind& kind : kKinds) {
    const Json* body = member(object, kind.name);
    if (body == nullptr) continue;
    request.kind = kind.kind;
    return read_fields(std::move(request), *body);
  }
  return refuse("expected subscribe, unsubscribe, query, reset or save");
}

}  // namespace lilo
