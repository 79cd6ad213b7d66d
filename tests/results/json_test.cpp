#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "example.hpp"
#include <continuo/results/json.hpp>
#include <continuo/results/sha256.hpp>

namespace continuo::results {
namespace {

using nlohmann::json;

TEST(Sha256, GivesThePublishedDigests) {  // FIPS 180-2, B.1 and B.2; NIST's vector of a million letters a
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Manifest, SaysWhatWasRunAndHow) {
  const json object = json::parse(manifest(falling_ball().model, falling_ball().run, "0.1.0"));
  EXPECT_EQ(object["continuo"], "0.1.0");
  EXPECT_EQ(object["model"]["text"], "model Ball\nh'' = -2\n");
  EXPECT_EQ(object["model"]["sha256"], sha256("model Ball\nh'' = -2\n"));
  EXPECT_EQ(object["parameters"], (json{{"g", 2.0}}));
  EXPECT_EQ(object["method"], "dop853");
  EXPECT_EQ(object["rtol"], 1e-10);
  EXPECT_EQ(object["atol"], json::array({1e-12}));
  EXPECT_EQ(object["statistics"]["evaluations"], 48);
  EXPECT_EQ(object["outcome"]["ending"], "reached end");
  EXPECT_EQ(object["hash"],
            manifest_hash(falling_ball().model, falling_ball().run.plan, std::array{1.0, 0.0}, "0.1.0"));
}

TEST(Manifest, HoldsTheLimitsOfStepsThatWereSaid) {
  Example limited = falling_ball();
  json object = json::parse(manifest(limited.model, limited.run, "0.1.0"));
  EXPECT_FALSE(object.contains("max_step") || object.contains("max_steps"));
  limited.run.plan.max_step = 0.25;
  limited.run.plan.max_steps = 1000;
  object = json::parse(manifest(limited.model, limited.run, "0.1.0"));
  EXPECT_EQ(object["max_step"], 0.25);
  EXPECT_EQ(object["max_steps"], 1000);
}

TEST(Manifest, TheHashForgetsTheClockAndThePlaceButNotAParameter) {
  const auto hash = [](const Example& example, std::string_view version = "0.1.0") {
    return manifest_hash(example.model, example.run.plan, example.run.first_state(), version);
  };
  Example first = falling_ball(), slower = falling_ball(), elsewhere = falling_ball(), heavier = falling_ball();
  slower.run.statistics.seconds = 9;
  elsewhere.model.text.path = "other/ball.sim";
  heavier.run.plan.variables[3] = 3;
  EXPECT_EQ(hash(first), hash(slower));
  EXPECT_EQ(hash(first), hash(elsewhere));
  EXPECT_NE(hash(first), hash(heavier));
  EXPECT_NE(hash(first), hash(first, "0.2.0"));
}

TEST(Manifest, TakesTextsThatAreNotUtf8) {
  auto [model, run] = falling_ball();
  model.text.content = "model \xff\n";
  EXPECT_EQ(json::parse(manifest(model, run, "0.1.0"))["model"]["text"], "model \xEF\xBF\xBD\n");
}

TEST(RunJson, HasExactlyTheKeysThatProgramsReadFromIt) {
  const json object = json::parse(run_json(falling_ball().run));
  EXPECT_EQ(object.size(), 7u);
  EXPECT_EQ(object["outcome"], "reached end");
  EXPECT_EQ(object["t"], 1.0);
  EXPECT_EQ(object["state"], (json{{"h", 0.0}, {"h'", 1.0}}));
  EXPECT_EQ(object["events"], json::parse(R"([{"name": "h falls through 0", "t": 1.0}])"));
  EXPECT_EQ(object["statistics"],
            json::parse(R"({"steps": 3, "rejected": 1, "evaluations": 48, "events": 1, "seconds": 0.25})"));
  EXPECT_EQ(object["energy"], (json{{"first", 2.0}, {"last", 0.5}, {"drift", 0.75}}));
  EXPECT_EQ(object["checks"][0]["passed"], true);
}

TEST(RunJson, AFailureSaysWhereAndWhy) {
  model::Run run = falling_ball().run;
  run.outcome = {.ending = Ending::step_too_small, .t = 0.75, .h = 1e-17, .error = 3, .component = "h'"};
  const json object = json::parse(run_json(run));
  EXPECT_EQ(object["outcome"], "step too small");
  EXPECT_EQ(object["failure"]["t"], 0.75);
  EXPECT_EQ(object["failure"]["component"], "h'");
}

TEST(RunJson, WhatIsNotFiniteIsNull) {
  model::Run run = falling_ball().run;
  run.motion.values.back() = std::nan("");
  EXPECT_TRUE(json::parse(run_json(run))["state"]["h'"].is_null());
}

}  // namespace
}  // namespace continuo::results
