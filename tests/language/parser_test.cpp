// Every form of statement, and its syntax tree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/language/syntax/format.hpp>
#include <continuo/language/syntax/parser.hpp>

namespace continuo::model {
namespace {

ast::Model parsed(const std::string& text) {
  const Source source("test.sim", text);
  ParseResult result = parse(source);
  EXPECT_TRUE(result.diagnostics.empty()) << render(result.diagnostics, source);
  return result.model;
}

/// The only statement of the text.
template <class Node>
Node only(const std::string& text) {
  const ast::Model model = parsed(text);
  EXPECT_EQ(model.statements.size(), 1U) << text;
  return std::get<Node>(model.statements.at(0).node);
}

template <class Node>
Node action(const std::string& text) {
  const auto event = only<ast::When>("when h < 0 { " + text + " }");
  EXPECT_EQ(event.actions.size(), 1U) << text;
  return std::get<Node>(event.actions.at(0).node);
}

std::string text_of(const std::optional<ast::Expression>& expression) {
  return expression ? to_text(*expression) : "";
}

TEST(Parsing, TheHeadingAndTheNameAreKept) {
  const ast::Model model = parsed("# A ball.\n# It bounces.\nmodel Ball\nx' = 1\n");
  EXPECT_EQ(model.heading, "A ball.\nIt bounces.");
  ASSERT_TRUE(model.name);
  EXPECT_EQ(model.name->text, "Ball");
  EXPECT_EQ(model.statements.size(), 1U);
}

TEST(Parsing, ParametersComeInListsWithUnitsAndRanges) {
  const auto list =
      only<ast::Parameters>("param g = 9.8 [m/s^2], e = 0.9 in 0..1, v = 0.01 [m/s] in 0..10 [cm/s]").items;
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(to_text(list[0].value), "9.8 [m/s^2]");
  EXPECT_FALSE(list[0].range);
  EXPECT_EQ(to_text(*list[1].range), "0..1");
  EXPECT_EQ(to_text(*list[2].range), "0..10 [cm/s]");
  EXPECT_EQ(list[2].name.text, "v");
}

TEST(Parsing, AnIndexedParameterHasAListOrAFormula) {
  const auto list = only<ast::Parameters>("param m[1..3] = (3, -1, 2*pi), n[1..N] = (1, 2) [kg]").items;
  ASSERT_TRUE(list[0].elements);
  EXPECT_EQ(to_text(*list[0].elements), "1..3");
  EXPECT_EQ(to_text(list[0].value), "(3, -1, 2*pi)");
  EXPECT_EQ(to_text(list[1].value), "(1 [kg], 2 [kg])");
  const auto family = only<ast::Family>("for i in 1..3 { param m[i] = 2*i }");
  EXPECT_EQ(to_text(std::get<ast::Parameters>(family.body.at(0).node).items.at(0).name), "m[i]");
}

TEST(Parsing, LetOutputAndEnergyTakeLists) {
  EXPECT_EQ(only<ast::Lets>("let a = x + 1, b[2] = 3").items.size(), 2U);
  EXPECT_EQ(only<ast::Outputs>("output a = x,\n b = y").items.size(), 2U);
  EXPECT_EQ(only<ast::Energies>("energy kinetic = 1/2*v^2, potential = g*h").items.size(), 2U);
}

TEST(Parsing, InputsHaveKeysAndFiles) {
  const auto key = only<ast::Input>("input u = 0 [N] in -5..5 key \"w\"");
  EXPECT_EQ(key.key, "w");
  EXPECT_FALSE(key.file);
  EXPECT_EQ(to_text(*key.definition.range), "-5..5");
  const auto file = only<ast::Input>("input u = 0 in 0..1 key \"w\" from \"car.csv\" step");
  EXPECT_EQ(file.file, "car.csv");
  EXPECT_EQ(file.interpolation, ast::Interpolation::step);
  EXPECT_EQ(only<ast::Input>("input u = 0 from \"car.csv\"").interpolation, ast::Interpolation::linear);
  EXPECT_EQ(only<ast::Input>("input u = 0 from \"car.csv\" linear").interpolation, ast::Interpolation::linear);
}

TEST(Parsing, TablesNameTheirFile) {
  const auto table = only<ast::Table>("table drag from \"drag.csv\"");
  EXPECT_EQ(table.name.text, "drag");
  EXPECT_EQ(table.file, "drag.csv");
}

TEST(Parsing, AnEquationHasAnyTwoSides) {
  EXPECT_EQ(to_text(only<ast::Equation>("x'' = -k/m*x")), "x'' = -k/m*x");
  EXPECT_EQ(to_text(only<ast::Equation>("m*x'' + k*x = F")), "m*x'' + k*x = F");
  EXPECT_EQ(to_text(only<ast::Equation>("x' + 32*x'' + x''' = 0")), "x' + 32*x'' + x''' = 0");
  EXPECT_EQ(to_text(only<ast::Equation>("0 = x^2 + y^2 - 1")), "0 = x^2 + y^2 - 1");
  EXPECT_EQ(to_text(only<ast::Equation>("u[1]' = u[2] - u[1]")), "u[1]' = u[2] - u[1]");
  EXPECT_EQ(to_text(only<ast::Equation>("sin(x) = y'")), "sin(x) = y'");
}

TEST(Parsing, AValueAtATimeIsACondition) {
  const auto initial = only<ast::Condition>("h'(0) = 3 [m/s]");
  EXPECT_EQ(to_text(initial.name), "h'");
  EXPECT_EQ(to_text(initial.time), "0");
  EXPECT_EQ(to_text(initial.value), "3 [m/s]");
  EXPECT_EQ(to_text(only<ast::Condition>("x(7) = 4").time), "7");
  const auto family = only<ast::Family>("for i in 1..N { u[i]'(0) = i }");
  EXPECT_EQ(to_text(std::get<ast::Condition>(family.body.at(0).node).name), "u[i]'");
}

TEST(Parsing, UnknownsAndGuessesHaveValues) {
  EXPECT_EQ(to_text(only<ast::Unknown>("unknown z = 1 [m]").guess), "1 [m]");
  EXPECT_EQ(to_text(only<ast::Guess>("guess x = 3*t").value), "3*t");
}

TEST(Parsing, ModesHoldEquations) {
  const auto mode = only<ast::Mode>("mode flight { h'' = -g; let a = 1\n for i in 1..2 { x[i]' = 0 } }");
  EXPECT_EQ(mode.name.text, "flight");
  EXPECT_EQ(mode.body.size(), 3U);
  EXPECT_EQ(only<ast::Start>("start in flight").mode.text, "flight");
}

TEST(Parsing, EventsHaveADirectionAndALevel) {
  const auto falls = only<ast::When>("when h falls through 0 in flight { h' := -e*h' }");
  EXPECT_EQ(falls.direction, Direction::falls);
  EXPECT_EQ(text_of(falls.level), "0");
  ASSERT_TRUE(falls.mode);
  EXPECT_EQ(falls.mode->text, "flight");
  EXPECT_EQ(event_name(falls), "h falls through 0 in flight");
  EXPECT_EQ(event_name(only<ast::When>("when x - y rises 2*a { stop }")), "x - y rises through 2*a");
  EXPECT_EQ(only<ast::When>("when x crosses through 1 { stop }").direction, Direction::crosses);
}

TEST(Parsing, AConditionIsAnEventWhenItBecomesTrue) {
  const auto event = only<ast::When>("when h < 0 and v > 1 { stop }");
  EXPECT_FALSE(event.direction);
  EXPECT_FALSE(event.level);
  EXPECT_EQ(event_name(event), "h < 0 and v > 1");
}

TEST(Parsing, TheBraceOfABlockMayStandOnTheNextLine) {
  EXPECT_EQ(only<ast::When>("when h < 0\n{\n stop\n}").actions.size(), 1U);
}

TEST(Parsing, AnEventSaysAfterThenWhatHappensAtItsLimit) {
  EXPECT_FALSE(only<ast::When>("when h falls through 0 { stop }").limit_actions);
  const auto both = only<ast::When>("when h falls through 0 in flight { h' := -h' } then { h' := 0; go rest }");
  EXPECT_EQ(both.actions.size(), 1U);
  EXPECT_EQ(both.limit_actions.value().size(), 2U);
  EXPECT_EQ(event_name(both), "h falls through 0 in flight");
  const auto brief = only<ast::When>("when h < 0 {\n h' := -h'\n}\nthen go rest");
  ASSERT_EQ(brief.limit_actions.value().size(), 1U);
  EXPECT_EQ(std::get<ast::Go>(brief.limit_actions->front().node).mode.text, "rest");
  EXPECT_TRUE(only<ast::When>("when h < 0 { h' := -h' } then { }").limit_actions.value().empty());
}

TEST(Parsing, TimesAndPeriodsAreEvents) {
  EXPECT_EQ(event_name(only<ast::At>("at 3 [s] { x := 1 }")), "at 3 [s]");
  EXPECT_EQ(event_name(only<ast::Every>("every 0.1 { x := 1 }")), "every 0.1");
  EXPECT_EQ(event_name(only<ast::Every>("every 24 [h] from 8 [h] { x := 1 }")), "every 24 [h] from 8 [h]");
  EXPECT_EQ(only<ast::Initially>("initially { x := 1; y := 2 }").actions.size(), 2U);
}

TEST(Parsing, ActionsAssignChooseGoMarkAndStop) {
  const auto assignment = action<ast::Assignment>("h' := -e*h'");
  EXPECT_EQ(to_text(assignment.target), "h'");
  EXPECT_EQ(to_text(assignment.value), "-e*h'");
  EXPECT_EQ(action<ast::Go>("go rest").mode.text, "rest");
  EXPECT_EQ(action<ast::Mark>("mark \"apex\"").text, "apex");
  EXPECT_EQ(action<ast::Stop>("stop").text, "");
  EXPECT_EQ(action<ast::Stop>("stop \"landed\"").text, "landed");
  EXPECT_EQ(text_of(action<ast::Stop>("stop \"enough\" after 5").after), "5");
  EXPECT_EQ(action<ast::ActionFamily>("for i in 1..3 { v[i] := 0 }").body.size(), 1U);
}

TEST(Parsing, ElseMayStandOnTheNextLineAndHoldAnotherIf) {
  const auto choice = action<ast::If>("if a < b { x := 1 }\n else if a > b { x := 2 }\n else { x := 3; go rest }");
  EXPECT_EQ(choice.then.size(), 1U);
  ASSERT_EQ(choice.otherwise.size(), 1U);
  const auto& second = std::get<ast::If>(choice.otherwise[0].node);
  EXPECT_EQ(second.otherwise.size(), 2U);
}

TEST(Parsing, FamiliesNest) {
  const auto outer = only<ast::Family>("for i in 1..N { for j in i+1..2*N { u[i, j]' = 1 } }");
  EXPECT_EQ(to_text(outer.range), "1..N");
  EXPECT_EQ(to_text(std::get<ast::Family>(outer.body.at(0).node).range), "i + 1..2*N");
}

TEST(Parsing, TheRunTakesItsPartsInAnyOrder) {
  const auto run = only<ast::Run>("run 0..60 [s] output 0.02 method dop853 tol 1e-10, abs (1e-12, 1e-9)\n");
  EXPECT_EQ(to_text(*run.interval), "0..60 [s]");
  EXPECT_EQ(to_text(std::get<ast::OutputEvery>(*run.output).interval), "0.02");
  EXPECT_EQ(run.method->text, "dop853");
  EXPECT_EQ(text_of(run.relative_tolerance), "1e-10");
  EXPECT_EQ(run.absolute_tolerance.size(), 2U);
  EXPECT_FALSE(run.realtime);
  const auto other = only<ast::Run>("run 0..2*pi, realtime, step 0.1, method rk4,\n output steps");
  EXPECT_TRUE(other.realtime);
  EXPECT_EQ(text_of(other.step), "0.1");
  EXPECT_TRUE(std::holds_alternative<ast::OutputSteps>(*other.output));
}

TEST(Parsing, LogarithmicOutputNamesItsDecades) {
  const auto run = only<ast::Run>("run 0..1e11 output log 10 per decade from 1e-3 tol 1e-6");
  const auto& output = std::get<ast::OutputLogarithmic>(*run.output);
  EXPECT_EQ(to_text(output.per_decade), "10");
  EXPECT_EQ(to_text(output.from), "0.001");
  EXPECT_EQ(text_of(run.relative_tolerance), "1e-06");
}

TEST(Parsing, PlotsNameCurvesAndTheirAxis) {
  const auto plot = only<ast::Plot>("plot h, energy, x^2 against t");
  EXPECT_EQ(plot.curves.size(), 3U);
  EXPECT_EQ(to_text(plot.curves[1]), "energy");
  EXPECT_EQ(text_of(plot.against), "t");
  EXPECT_FALSE(only<ast::Plot>("plot h").against);
}

TEST(Parsing, DrawingsHoldShapesWithAttributes) {
  const auto draw = only<ast::Draw>(
      "draw { floor 0; ball (0, h) radius 0.3 color \"red\" label \"m\"; spring (0, 0) to (x, y) turns 8\n"
      "rod (0, 0) (x, y); rope (0, 0, 1) (x, y, z); arrow (x, y) (x + v, y); trail (x, y) length 5\n"
      "box (x, 0.7) drag size (4, 1.4) angle a; text (x, 3) \"car\"; for i in 1..N { ball (x[i], y[i]) radius r[i] } "
      "}");
  ASSERT_EQ(draw.items.size(), 10U);
  const auto& ball = std::get<ast::Shape>(draw.items[1].node);
  EXPECT_EQ(ball.kind, ast::ShapeKind::ball);
  EXPECT_EQ(to_text(ball.arguments.at(0)), "(0, h)");
  ASSERT_EQ(ball.attributes.size(), 3U);
  EXPECT_EQ(ball.attributes[0].name.text, "radius");
  EXPECT_EQ(std::get<ast::Text>(ball.attributes[1].value.node).value, "red");
  EXPECT_EQ(std::get<ast::Shape>(draw.items[2].node).arguments.size(), 2U);
  EXPECT_EQ(std::get<ast::Shape>(draw.items[7].node).attributes.at(0).name.text, "drag");
  EXPECT_EQ(to_text(std::get<ast::Shape>(draw.items[7].node).attributes.at(1).value), "(4, 1.4)");
  EXPECT_EQ(std::get<ast::DrawFamily>(draw.items[9].node).body.size(), 1U);
}

TEST(Parsing, ChecksOfValuesNameTheirMoment) {
  const auto call = only<ast::Check>("check h(1) = 5.1 [m] within 1e-9");
  EXPECT_EQ(to_text(std::get<ast::ValueOf>(call.measure).expression), "h(1)");
  EXPECT_EQ(call.relation, ast::Relation::equal);
  EXPECT_EQ(to_text(call.value), "5.1 [m]");
  EXPECT_EQ(text_of(call.tolerance), "1e-09");
  const auto at = only<ast::Check>("check x^2 + v^2 at 3 [s] < 25");
  EXPECT_EQ(to_text(std::get<ast::AtTime>(std::get<ast::ValueOf>(at.measure).moment).time), "3 [s]");
  EXPECT_EQ(at.relation, ast::Relation::less);
  const auto end = only<ast::Check>("check x at end >= 0");
  EXPECT_TRUE(std::holds_alternative<ast::AtEnd>(std::get<ast::ValueOf>(end.measure).moment));
  const auto after = only<ast::Check>("check h' after event 2 of \"h falls\" = 4.9 within 1e-9");
  const auto& event = std::get<ast::AtEvent>(std::get<ast::ValueOf>(after.measure).moment);
  EXPECT_TRUE(event.after);
  EXPECT_EQ(to_text(event.number), "2");
  EXPECT_EQ(event.event, "h falls");
  const auto before = only<ast::Check>("check h' at event 2 = 4.9 within 1e-9");
  EXPECT_FALSE(std::get<ast::AtEvent>(std::get<ast::ValueOf>(before.measure).moment).after);
}

TEST(Parsing, ChecksOfTheWholeRun) {
  EXPECT_TRUE(std::holds_alternative<ast::AlwaysValueOf>(only<ast::Check>("check always h >= -1e-12").measure));
  EXPECT_TRUE(std::holds_alternative<ast::EnergyDrift>(only<ast::Check>("check energy drift < 1e-8").measure));
  EXPECT_TRUE(std::holds_alternative<ast::TimeOfEnd>(only<ast::Check>("check time of end = 3 within 0").measure));
  const auto time = only<ast::Check>("check time of event 3 of \"h falls\" = 1.5 within 1e-12");
  EXPECT_EQ(std::get<ast::TimeOfEvent>(time.measure).event.event, "h falls");
  EXPECT_EQ(std::get<ast::CountOfEvents>(only<ast::Check>("check count of \"h falls\" = 30").measure).event, "h falls");
  EXPECT_EQ(std::get<ast::CountOfEvents>(only<ast::Check>("check count of events <= 30").measure).event, "");
}

TEST(Parsing, NamesThatOnlyLookLikeWordsAreNames) {
  EXPECT_EQ(parsed("let time = t, count = 3, step = 1, output_ = 2\nend' = time + count\nalways' = through\n")
                .statements.size(),
            3U);
}

TEST(Parsing, SpansCoverWhatWasWritten) {
  const Source source("test.sim", "  x'' = -k/m*x  # force\nwhen h falls through 0 in flight { stop }");
  const ast::Model model = parse(source).model;
  EXPECT_EQ(source.slice(model.statements.at(0).span), "x'' = -k/m*x");
  EXPECT_EQ(source.slice(std::get<ast::Equation>(model.statements[0].node).right.span), "-k/m*x");
  EXPECT_EQ(source.slice(std::get<ast::When>(model.statements.at(1).node).head), "when h falls through 0 in flight");
}

TEST(Parsing, EveryModelOfTheGalleryIsReadWithoutAMessage) {
  int models = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CONTINUO_SOURCE_DIR "/models")) {
    if (entry.path().extension() != ".sim") continue;
    const auto source = read_source(entry.path());
    ASSERT_TRUE(source) << entry.path();
    const ParseResult result = parse(*source);
    EXPECT_TRUE(result.diagnostics.empty()) << render(result.diagnostics, *source);
    EXPECT_NE(result.model.heading, "") << entry.path() << ": a model of the gallery teaches in its heading";
    ++models;
  }
  EXPECT_GE(models, 20);
}

}  // namespace
}  // namespace continuo::model
