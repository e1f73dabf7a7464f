// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/request.hpp"

#include "daemon/client_table.hpp"

#include <boost/asio/ip/address_v4.hpp>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace lilo {
namespace {

TEST(Request, ReadsEveryKind) {
  const auto subscribe = parse_request(R"({"subscribe":{"ttl_s":2.5},"token":"abc","new":1})");
  ASSERT_TRUE(subscribe.request);
  EXPECT_EQ(subscribe.request->kind, RequestKind::subscribe);
  EXPECT_EQ(subscribe.request->ttl_s, 2.5);
  EXPECT_EQ(subscribe.request->token, "abc");
  EXPECT_FALSE(subscribe.request->wants.points || subscribe.request->wants.packets);
  EXPECT_TRUE(parse_request(R"({"subscribe":{"points":true}})").request->wants.points);
  const Extras packets = parse_request(R"({"subscribe":{"packets":true}})").request->wants;
  EXPECT_TRUE(packets.packets && !packets.points);
  EXPECT_EQ(parse_request(R"({"unsubscribe":{}})").request->kind, RequestKind::unsubscribe);
  EXPECT_EQ(parse_request(R"({"query":"pose"})").request->query, "pose");
  const auto reset = parse_request(
      R"({"reset":{"pose":{"position":{"x":1,"y":2,"z":3},"orientation":{"x":0,"y":0,"z":0,"w":1}}}})");
  ASSERT_TRUE(reset.request && reset.request->start_pose);
  EXPECT_EQ(reset.request->start_pose->translation_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(parse_request(R"({"reset":{}})").request->start_pose);
  EXPECT_EQ(parse_request(R"({"save":"map"})").request->save, SaveKind::map);
  EXPECT_EQ(parse_request(R"({"save":"trajectory"})").request->save, SaveKind::trajectory);
}

TEST(Request, SaysWhatIsWrong) {
  for (
      const char* bad :
      {"", "x", "[]", "1", "null", "{}", R"({"subscribe":1})", R"({"subscribe":{"ttl_s":"5"}})",
       R"({"subscribe":{"ttl_s":1e999}})", R"({"subscribe":{"points":1}})",
       R"({"subscribe":{"packets":"yes"}})", R"({"query":{}})", R"({"save":{}})",
       R"({"save":"../map"})", R"({"token":5,"query":"pose"})", R"({"reset":{"pose":1}})",
       R"({"reset":{"pose":{"position":{"x":1,"y":2,"z":3}}}})",
       R"({"reset":{"pose":{"position":{"x":1,"y":2,"z":3},"orientation":{"x":0,"y":0,"z":0,"w":2}}}})",
       R"({"subscribe":{}} {"subscribe":{}})"}) {
    const auto parsed = parse_request(bad);
    EXPECT_FALSE(parsed.request) << bad;
    EXPECT_FALSE(parsed.error.empty()) << bad;
  }
  EXPECT_FALSE(parse_request(R"({"subscribe":{},"x":")" + std::string(600, 'x') + "\"}").request);
}

// Bytes at random, and every prefix and every changed byte of a good request: never a crash.
TEST(Request, SurvivesAnything) {
  std::mt19937 rng(1);
  std::string bytes(512, '\0');
  for (int k = 0; k < 2000; ++k) {
    for (char& c : bytes) c = static_cast<char>(rng());
    EXPECT_FALSE(parse_request(bytes).request);
  }
  const std::string good = R"({"subscribe":{"ttl_s":2.5},"token":"abc"})";
  for (std::size_t k = 0; k < good.size(); ++k) {
    EXPECT_FALSE(parse_request(good.substr(0, k)).request);
    std::string changed = good;
    changed[k] = static_cast<char>(rng());
    parse_request(changed);
  }
  EXPECT_FALSE(parse_request(std::string(512, '[')).request);
}

TEST(ClientTable, IsBoundedAndForgets) {
  using boost::asio::ip::udp;
  ClientTable table({.clients = 2});
  const auto client = [](std::uint16_t port) {
    return udp::endpoint(boost::asio::ip::address_v4::loopback(), port);
  };
  EXPECT_TRUE(table.renew(client(1), 100));
  EXPECT_TRUE(table.renew(client(2), 200));
  EXPECT_FALSE(table.renew(client(3), 300)) << "full";
  EXPECT_TRUE(table.renew(client(1), 250)) << "a renewal needs no room";
  EXPECT_EQ(table.clients().size(), 2U);
  table.expire(200);
  EXPECT_FALSE(table.contains(client(2)));
  EXPECT_TRUE(table.contains(client(1)));
  EXPECT_TRUE(table.renew(client(3), 300));
  table.remove(client(1));
  table.remove(client(9));
  EXPECT_EQ(table.clients().size(), 1U);
}

TEST(ClientTable, BoundsThoseWithPointsAndPackets) {
  using boost::asio::ip::udp;
  ClientTable table({.clients = 4, .points = 1, .packets = 1});
  const auto client = [](std::uint16_t port) {
    return udp::endpoint(boost::asio::ip::address_v4::loopback(), port);
  };
  for (const auto extra : {&Extras::points, &Extras::packets}) {
    Extras wanted;
    wanted.*extra = true;
    const auto has = [&](std::uint16_t port, std::int64_t lease_end_ns, Extras wants) {
      return table.renew(client(port), lease_end_ns, wants)->has.*extra;
    };
    EXPECT_FALSE(has(1, 100, {})) << "not asked for";
    EXPECT_TRUE(has(2, 100, wanted));
    EXPECT_FALSE(has(1, 100, wanted)) << "only one may";
    EXPECT_TRUE(has(2, 200, wanted)) << "a renewal needs no room";
    EXPECT_FALSE(has(2, 200, {})) << "given back";
    EXPECT_TRUE(has(1, 200, wanted));
    EXPECT_EQ(table.points_clients() + table.packets_clients(), 1U);
    table.expire(200);
    EXPECT_EQ(table.points_clients() + table.packets_clients(), 0U);
  }
}

}  // namespace
}  // namespace lilo
