// The origins and hosts from which the server accepts requests.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/live/server/origin_guard.hpp>

namespace continuo::live {
namespace {

const std::string token = "0123456789abcdef0123456789abcdef";
const Tokens tokens{token, "abcdefghjk"};

Request request_for(std::string_view target) {
  return {.method = "GET", .target = target, .host = "127.0.0.1:4000"};
}

TEST(OriginGuard, LetsInWhoKnowsTheToken) {
  const OriginGuard origin_guard(tokens, "127.0.0.1", 4000);
  const std::string page = "/?token=" + token, live = "/live?x=1&token=" + token;
  EXPECT_EQ(origin_guard.judge(request_for(page)).verdict, Verdict::page);
  Request socket = request_for(live);
  socket.upgrade = true;
  EXPECT_EQ(origin_guard.judge(socket).verdict, Verdict::live);
  socket.origin = "http://127.0.0.1:4000";
  EXPECT_EQ(origin_guard.judge(socket).verdict, Verdict::live);
  for (const std::string& wrong :
       std::vector<std::string>{"", "/?", "/?token=", "/?token=0123", "/?token=" + token + "0", "/?Token=" + token})
    EXPECT_NE(origin_guard.judge(request_for("/" + wrong)).verdict, Verdict::page) << wrong;
  EXPECT_EQ(origin_guard.judge(request_for("/?token=" + token.substr(1) + "0")).verdict, Verdict::wrong_token);
}

TEST(OriginGuard, KeepsOtherPagesOut) {
  const OriginGuard origin_guard(tokens, "127.0.0.1", 4000);
  const std::string live = "/live?token=" + token;
  Request socket = request_for(live);
  socket.upgrade = true;
  for (const std::string_view other :
       {"http://evil.example", "https://127.0.0.1:4000", "http://127.0.0.1:4001", "null"}) {
    socket.origin = other;
    EXPECT_EQ(origin_guard.judge(socket).verdict, Verdict::wrong_origin) << other;
  }
}

// DNS rebinding: an attacker's name server resolves evil.example to 127.0.0.1, so that its page and our server have the
// same origin.
TEST(OriginGuard, GoesByItsOwnNameAlone) {
  const OriginGuard origin_guard(tokens, "127.0.0.1", 4000);
  const std::string page = "/?token=" + token;
  Request request = request_for(page);
  for (const std::string_view other : {"evil.example:4000", "127.0.0.1", "", "127.0.0.1:4001"}) {
    request.host = other;
    EXPECT_EQ(origin_guard.judge(request).verdict, Verdict::wrong_host) << other;
  }
  request.host = "localhost:4000";
  EXPECT_EQ(origin_guard.judge(request).verdict, Verdict::page);
  const OriginGuard open(tokens, "0.0.0.0", 4000);  // an open address: any host name is accepted
  request.host = "lecture.example:4000";
  EXPECT_EQ(open.judge(request).verdict, Verdict::page);
}

TEST(OriginGuard, HasNothingElse) {
  const OriginGuard origin_guard(tokens, "127.0.0.1", 4000);
  for (const std::string path :
       {"/../etc/passwd", "/live/../../etc/passwd", "/%2e%2e/etc/passwd", "/favicon.ico", "*", ""})
    EXPECT_EQ(origin_guard.judge(request_for(path + "?token=" + token)).verdict, Verdict::not_found) << path;
  const std::string page = "/?token=" + token;
  Request request = request_for(page);
  request.method = "POST";
  EXPECT_EQ(origin_guard.judge(request).verdict, Verdict::wrong_method);
}

TEST(OriginGuard, TellsViewersFromPresenters) {
  const OriginGuard origin_guard(tokens, "127.0.0.1", 4000);
  EXPECT_EQ(origin_guard.judge(request_for("/?token=" + token)).role, Role::presenter);
  EXPECT_EQ(origin_guard.judge(request_for("/?token=" + token + "&own")).role, Role::presenter);
  EXPECT_EQ(origin_guard.judge(request_for("/?token=abcdefghjk")).role, Role::viewer);
  EXPECT_EQ(origin_guard.judge(request_for("/?token=abcdefghjk&own")).role, Role::owner);
  EXPECT_EQ(origin_guard.judge(request_for("/abcdefghjk")).verdict, Verdict::short_address);
  EXPECT_EQ(origin_guard.judge(request_for("/abcdefghjm")).verdict, Verdict::not_found);
  EXPECT_EQ(origin_guard.judge(request_for("/?token=abcdefghj")).verdict, Verdict::wrong_token);
}

TEST(OriginGuard, KnowsTheAddressForTheBrowsersCommandLine) {
  const std::string first = "fedcba9876543210fedcba9876543210";
  const OriginGuard origin_guard({token, "abcdefghjk", first}, "127.0.0.1", 4000);
  EXPECT_EQ(origin_guard.judge(request_for("/" + first)).verdict, Verdict::first_address);
  EXPECT_EQ(origin_guard.judge(request_for("/?token=" + first)).verdict, Verdict::wrong_token);
  EXPECT_EQ(origin_guard.judge(request_for("/" + token)).verdict, Verdict::not_found);
  const OriginGuard without(tokens, "127.0.0.1", 4000);  // a session that no browser is started for
  EXPECT_EQ(without.judge(request_for("/")).verdict, Verdict::wrong_token);
}

TEST(OriginGuard, TokensDiffer) {
  EXPECT_EQ(make_tokens().presenter.size(), 32U);
  EXPECT_EQ(make_tokens().viewers.size(), 10U);
  EXPECT_EQ(make_tokens().first.size(), 32U);
  EXPECT_NE(make_tokens().first, make_tokens().first);
  EXPECT_NE(make_tokens().presenter, make_tokens().presenter);
  EXPECT_NE(make_tokens().viewers, make_tokens().viewers);
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
