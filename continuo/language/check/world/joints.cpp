// What a joint connects, where, and what it does to its coordinate.
#include <algorithm>
#include <array>
#include <variant>

#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/body_names.hpp>
#include <continuo/language/check/world/joints.hpp>

namespace continuo::model::detail {

namespace {

const ast::Expression* given(const JointText& text, std::string_view name) {
  return attribute(text.text->attributes, name);
}
bool has_angle(std::string_view kind) {
  return kind == "hinge";
}
bool is_distance(std::string_view kind) {
  return kind == "distance" || kind == "rope";
}

}  // namespace

void Joints::make() {
  for (std::size_t i = 0; i < text_.joints.size(); ++i) {
    const JointText& text = text_.joints[i];
    Scope scope = text.scope;
    auto joint = connected(text, scope);
    if (!joint || !can_move(*joint, text)) continue;
    place(*joint, text, scope);
    read_axes(*joint, text, scope);
    read_limits(*joint, text, scope);
    read_spring(*joint, text, scope);
    joint->kind == "pull" ? read_pull(*joint, text, scope) : read_motor(*joint, text, scope);
    read_strength(*joint, text, scope);
    joint->collide = given(text, "collide") != nullptr;
    work_.made.joints.push_back(std::move(*joint));
    work_.joint_texts.push_back(i);
  }
}

std::optional<JointDescription> Joints::connected(const JointText& text, Scope& scope) {
  const ast::WorldJoint& joint = *text.text;
  const auto first = body_named(joint.first, scope, expressions_);
  JointDescription made;
  made.name = text.name;
  made.kind = joint.kind.text;
  made.span = text.span;
  made.is_named = text.is_named();
  if (text.base != JointText::no_base) made.first_measure = expressions_.workspace.declared.bases[text.base].first;
  if (const auto* name = std::get_if<ast::Name>(&joint.second)) {
    const auto second = body_named(*name, scope, expressions_);
    if (!second) return std::nullopt;
    made.second = *second;
  }
  if (!first) return std::nullopt;
  made.first = *first;
  if (made.kind == "pull" && !std::holds_alternative<ast::Expression>(joint.second)) {
    report_.fail("E225", text.span, "a pull draws a body to a point", {},
                 fmt::format("write pull {} to {} spring 2 [Hz]; two bodies are drawn together by a spring",
                             report_.slice(joint.first.span), text_.dimension == 2 ? "(x, y)" : "(x, y, z)"));
    return std::nullopt;
  }
  if (std::holds_alternative<ast::Expression>(joint.second) && !is_distance(made.kind) && made.kind != "pull") {
    report_.fail("E225", std::get<ast::Expression>(joint.second).span,
                 fmt::format("a {} connects two bodies, or a body and the world", made.kind), "this is a point",
                 fmt::format("write {} {} at {}", made.kind, report_.slice(joint.first.span),
                             report_.slice(std::get<ast::Expression>(joint.second).span)));
    return std::nullopt;
  }
  if (made.kind == "universal" && text_.dimension == 2) {
    report_.fail("E227", joint.kind.span, "a universal joint exists in space only", {},
                 "in the plane a hinge leaves all turns free");
    return std::nullopt;
  }
  return made;
}

/// E225 where both ends are the same body, or neither moves.
bool Joints::can_move(const JointDescription& joint, const JointText& text) {
  if (joint.first == joint.second) {
    report_.fail("E225", text.span, "a joint connects two bodies", "both are the same body",
                 "name another one, or leave `to` out to connect it with the world");
    return false;
  }
  const std::vector<BodyDescription>& bodies = work_.made.bodies;
  if (!bodies[joint.first].fixed || (joint.second != no_body && !bodies[joint.second].fixed)) return true;
  report_.fail("E225", text.span, "a joint needs a body that can move",
               joint.second == no_body ? fmt::format("`{}` {}", bodies[joint.first].name,
                                                     bodies[joint.first].character ? "walks" : "is fixed")
                                       : "both are fixed",
               "leave out `fixed`, or the joint");
  return false;
}

NodePoint Joints::start_of(std::size_t body) const {
  NodePoint start{};
  for (std::size_t axis = 0; axis < text_.axes(); ++axis)
    start[axis] = states_[work_.made.bodies[body].first_state + 2 * axis].initial;
  return start;
}

/// `at` is one place for both; without it the centre of the first body, where that is of no meaning.
void Joints::place(JointDescription& joint, const JointText& text, Scope& scope) {
  if (is_distance(joint.kind)) return place_ends(joint, text, scope);
  joint.anchor_first = start_of(joint.first);
  if (const ast::Expression* at = given(text, "at")) {
    joint.anchor_first = numbers_.point(*at, scope, work_.length, "the place of a joint");
  } else if (joint.kind == "hinge" || joint.kind == "ball" || joint.kind == "wheel" || joint.kind == "universal") {
    report_.fail("E225", text.span, fmt::format("where is this {}?", joint.kind), {},
                 fmt::format("add at {}: where it holds the bodies at the start",
                             text_.dimension == 2 ? "(0, 1)" : "(0, 1, 0)"));
  }
  joint.anchor_second = joint.anchor_first;
}

void Joints::place_ends(JointDescription& joint, const JointText& text, Scope& scope) {
  const auto* point = std::get_if<ast::Expression>(&text.text->second);
  const ast::Expression* ends = given(text, "ends");
  if (ends) {
    const std::vector<ast::Expression>& points = std::get<ast::List>(ends->node).items;
    if (point || points.size() != 2) {
      report_.fail("E225", ends->span, fmt::format("a {} has two ends", joint.kind),
                   point ? "one stands after `to`" : fmt::format("these are {}", points.size()),
                   "write ends (0, 0) (0, 5): where it holds the first body and the second");
      return;
    }
    joint.anchor_first = numbers_.point(points[0], scope, work_.length, "the end of a joint");
    joint.anchor_second = numbers_.point(points[1], scope, work_.length, "the end of a joint");
  } else {
    joint.anchor_first = start_of(joint.first);
    if (point) {
      joint.anchor_second = numbers_.point(*point, scope, work_.length, "the end of a joint");
    } else if (joint.second != no_body) {
      joint.anchor_second = start_of(joint.second);
    } else {
      report_.fail("E225", text.span, fmt::format("where does this {} end?", joint.kind), {},
                   "add to (0, 5), or to another body");
    }
  }
  NodeId apart = graph_.constant(0);
  for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
    const NodeId from = joint.anchor_first[axis], to = joint.anchor_second[axis];
    if (!from.valid() || !to.valid()) return;
    apart = graph_.apply(Op::hypotenuse, apart, graph_.subtract(to, from));
  }
  numbers_.expect(apart, Sort::positive, text.span, "the distance of the ends of a joint");
}

void Joints::read_axes(JointDescription& joint, const JointText& text, Scope& scope) {
  const auto read = [&](std::string_view name, NodePoint& into) {
    const ast::Expression* axis = given(text, name);
    if (!axis) return false;
    into = numbers_.point(*axis, scope, Measured::unknown(), fmt::format("the {} of a joint", name));
    NodeId length = graph_.constant(0);
    for (std::size_t k = 0; k < text_.axes() && into[k].valid(); ++k)
      length = graph_.apply(Op::hypotenuse, length, into[k]);
    numbers_.expect(length, Sort::positive, axis->span, fmt::format("the length of an {}", name));
    return true;
  };
  const bool has_axis = read("axis", joint.axis), has_axle = read("axle", joint.axle), plane = text_.dimension == 2;
  const std::string_view kind = joint.kind;
  if (plane && has_axis && (kind == "hinge" || kind == "gear"))
    report_.fail("E225", given(text, "axis")->span, fmt::format("a {} of the plane has no axis", kind), {},
                 "all turns of the plane are about one axis: leave it out");
  if (plane && has_axle)
    report_.fail("E225", given(text, "axle")->span, "an axle exists in space only", {},
                 "all turns of the plane are about one axis: leave it out");
  const bool needs_axis = kind == "slider" || (!plane && (kind == "hinge" || kind == "universal" || kind == "gear"));
  if (needs_axis && !has_axis)
    report_.fail("E225", text.span, fmt::format("along which axis is this {}?", kind), {},
                 plane ? "add axis (1, 0)" : "add axis (0, 0, 1)");
  if (!plane && !has_axle && (kind == "wheel" || kind == "universal"))
    report_.fail("E225", text.span, fmt::format("about which axle does this {} turn?", kind), {},
                 "add axle (0, 1, 0), across the axis");
}

/// Ratios of numbers have no unit where lengths have none.
Measured Joints::pure() const {
  return work_.length.is_known() ? Measured::known(Unit()) : Measured::unknown();
}
Measured Joints::coordinate(std::string_view kind) const {
  return has_angle(kind) ? Measured::known(Unit()) : work_.length;
}
Measured Joints::force() const {
  return product(work_.mass, expressions_.workspace.time.per_time(work_.length, 2));
}

void Joints::read_limits(JointDescription& joint, const JointText& text, Scope& scope) {
  if (joint.kind == "rope") {
    if (const ast::Expression* length = given(text, "length")) {
      joint.upper = numbers_.number(*length, scope, work_.length, "the length of a rope", Sort::positive);
    } else {  // as long as it is at the start
      joint.upper = graph_.constant(0);
      for (std::size_t k = 0; k < text_.axes() && joint.anchor_first[k].valid() && joint.anchor_second[k].valid(); ++k)
        joint.upper =
            graph_.apply(Op::hypotenuse, joint.upper, graph_.subtract(joint.anchor_second[k], joint.anchor_first[k]));
    }
    joint.lower = graph_.constant(0);
    return;
  }
  const ast::Expression* limits = given(text, "limits");
  if (!limits) return;
  const std::vector<Term> ends = numbers_.components(*limits, scope, 2);
  if (ends.size() != 2) return;
  std::array<NodeId, 2> made;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!expressions_.values.only_parameters(ends[k].value.node, ends[k].text.span, "the limits of a joint")) return;
    made[k] =
        expressions_.operations.in_unit(ends[k].text, ends[k].value, coordinate(joint.kind), "the limits of a joint");
    numbers_.expect(made[k], Sort::any, ends[k].text.span, "the limit of a joint");
  }
  joint.lower = made[0], joint.upper = made[1];
  const auto lower = graph_.value(made[0]), upper = graph_.value(made[1]);
  if (lower && upper && *lower > *upper) {
    report_.fail("E225", limits->span, "these limits are upside down", {},
                 "the lower one comes first, as in limits -90..90 [deg]");
    return;
  }
  numbers_.expect(graph_.subtract(made[1], made[0]), Sort::not_negative, limits->span,
                  "the upper limit of a joint, less the lower one,");
}

void Joints::read_spring(JointDescription& joint, const JointText& text, Scope& scope) {
  const auto *spring = given(text, "spring"), *damping = given(text, "damping"), *rest = given(text, "rest");
  if (!spring) {
    for (const auto* other : {damping, rest})
      if (other)
        report_.fail("E225", other->span, "this is of a spring, and the joint has none", {},
                     "add spring 4 [Hz]: its frequency");
    return;
  }
  joint.hertz = numbers_.number(*spring, scope, expressions_.workspace.time.per_time(pure()),
                                "the frequency of a spring", Sort::not_negative);
  joint.damping = damping ? numbers_.number(*damping, scope, Measured::known(Unit()), "the damping ratio of a spring",
                                            Sort::not_negative)
                          : graph_.constant(1);
  joint.rest = rest ? numbers_.number(*rest, scope, coordinate(joint.kind), "the rest of a spring", Sort::any)
                    : graph_.constant(0);
}

/// All but its speed.
void Joints::read_motor(JointDescription& joint, const JointText& text, Scope& scope) {
  const std::string_view word = joint.kind == "slider" ? "force" : "torque";
  const auto *motor = given(text, "motor"), *most = given(text, word);
  if (!motor && !most) return;
  if (!motor || !most) {
    report_.fail("E225", (motor ? motor : most)->span,
                 motor ? "how strong is this motor?" : "this is of a motor, and the joint has none", {},
                 motor ? fmt::format("add {} at most 5", word) : "add motor 2: its speed");
    return;
  }
  const Measured wanted = word == "force" ? force() : product(force(), work_.length);
  joint.motor_most =
      numbers_.number(*most, scope, wanted, fmt::format("the greatest {} of a motor", word), Sort::not_negative);
  joint.motor_speed = graph_.constant(0);
}

/// Its greatest force; its spring is that of all joints.
void Joints::read_pull(JointDescription& joint, const JointText& text, Scope& scope) {
  if (!given(text, "spring"))
    report_.fail("E225", text.span, "how strong is this pull?", {}, "add spring 2 [Hz]: its frequency");
  if (const ast::Expression* most = given(text, "force"))
    joint.breaks_at = numbers_.number(*most, scope, force(), "the greatest force of a pull", Sort::not_negative);
}

void Joints::make_drives() {
  for (std::size_t k = 0; k < work_.made.joints.size(); ++k) {
    JointDescription& joint = work_.made.joints[k];
    const JointText& text = text_.joints[work_.joint_texts[k]];
    Scope scope = text.scope;
    if (joint.kind == "pull")
      joint.target = numbers_.point(std::get<ast::Expression>(text.text->second), scope, work_.length,
                                    "the target of a pull", false);
    const ast::Expression* motor = given(text, "motor");
    if (!motor || !joint.motor_speed.valid()) continue;
    const Value speed = expressions_.values.number_of(*motor, scope);
    const Measured moved = joint.kind == "slider" ? work_.length : pure();
    if (!speed.bad)
      joint.motor_speed = expressions_.operations.in_unit(*motor, speed, expressions_.workspace.time.per_time(moved),
                                                          "the speed of a motor");
  }
}

void Joints::read_strength(JointDescription& joint, const JointText& text, Scope& scope) {
  if (const ast::Expression* most = given(text, "breaks_at"))
    joint.breaks_at = numbers_.number(*most, scope, force(), "the force that breaks a joint", Sort::not_negative);
  if (const ast::Expression* most = given(text, "breaks_at_torque"))
    joint.breaks_at_torque = numbers_.number(*most, scope, product(force(), work_.length),
                                             "the torque that breaks a joint", Sort::not_negative);
  if (const ast::Expression* ratio = given(text, "ratio"))
    joint.ratio = numbers_.number(*ratio, scope, Measured::known(Unit()), "the ratio of gears", Sort::any);
}

}  // namespace continuo::model::detail
