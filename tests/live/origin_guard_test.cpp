// The origins and hosts from which the server accepts requests.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/live/server/origin_guard.hpp>

namespace continuo::live {
namespace {

const std::string token = "0123456789abcdef0123456789abcdef";

Request request_for(std::string_view target) {
  return {.method = "GET", .target = target, .host = "127.0.0.1:4000"};
}

TEST(OriginGuard, LetsInWhoKnowsTheToken) {
  const OriginGuard origin_guard(token, "127.0.0.1", 4000);
  const std::string page = "/?token=" + token, live = "/live?x=1&token=" + token;
  EXPECT_EQ(origin_guard.judge(request_for(page)), Verdict::page);
  Request socket = request_for(live);
  socket.upgrade = true;
  EXPECT_EQ(origin_guard.judge(socket), Verdict::live);
  socket.origin = "http://127.0.0.1:4000";
  EXPECT_EQ(origin_guard.judge(socket), Verdict::live);
  for (const std::string& wrong :
       std::vector<std::string>{"", "/?", "/?token=", "/?token=0123", "/?token=" + token + "0", "/?Token=" + token})
    EXPECT_NE(origin_guard.judge(request_for("/" + wrong)), Verdict::page) << wrong;
  EXPECT_EQ(origin_guard.judge(request_for("/?token=" + token.substr(1) + "0")), Verdict::wrong_token);
}

TEST(OriginGuard, KeepsOtherPagesOut) {
  const OriginGuard origin_guard(token, "127.0.0.1", 4000);
  const std::string live = "/live?token=" + token;
  Request socket = request_for(live);
  socket.upgrade = true;
  for (const std::string_view other :
       {"http://evil.example", "https://127.0.0.1:4000", "http://127.0.0.1:4001", "null"}) {
    socket.origin = other;
    EXPECT_EQ(origin_guard.judge(socket), Verdict::wrong_origin) << other;
  }
}

// DNS rebinding: an attacker's name server resolves evil.example to 127.0.0.1, so that its page and our server have the
// same origin.
TEST(OriginGuard, GoesByItsOwnNameAlone) {
  const OriginGuard origin_guard(token, "127.0.0.1", 4000);
  const std::string page = "/?token=" + token;
  Request request = request_for(page);
  for (const std::string_view other : {"evil.example:4000", "127.0.0.1", "", "127.0.0.1:4001"}) {
    request.host = other;
    EXPECT_EQ(origin_guard.judge(request), Verdict::wrong_host) << other;
  }
  request.host = "localhost:4000";
  EXPECT_EQ(origin_guard.judge(request), Verdict::page);
  const OriginGuard open(token, "0.0.0.0", 4000);  // an open address: any host name is accepted
  request.host = "lecture.example:4000";
  EXPECT_EQ(open.judge(request), Verdict::page);
}

TEST(OriginGuard, HasNothingElse) {
  const OriginGuard origin_guard(token, "127.0.0.1", 4000);
  for (const std::string path :
       {"/../etc/passwd", "/live/../../etc/passwd", "/%2e%2e/etc/passwd", "/favicon.ico", "*", ""})
    EXPECT_EQ(origin_guard.judge(request_for(path + "?token=" + token)), Verdict::not_found) << path;
  const std::string page = "/?token=" + token;
  Request request = request_for(page);
  request.method = "POST";
  EXPECT_EQ(origin_guard.judge(request), Verdict::wrong_method);
}

TEST(OriginGuard, TokensDiffer) {
  EXPECT_EQ(make_token().size(), 32U);
  EXPECT_NE(make_token(), make_token());
}

TEST(OriginGuard, SaysAThingOnce) {
  int said = 0;
  SayOnce once([&](const std::string&) { ++said; });
  for (int i = 0; i < 1000; ++i) once("refused");
  EXPECT_EQ(said, 1);
  EXPECT_EQ(once.counts().at("refused"), 1000U);
}

}  // namespace
}  // namespace continuo::live
