// continuo/language/check/world/world_at_work.hpp
// The world while it is made.
#pragma once
#include <string>
#include <vector>

#include <continuo/language/check/names/scope.hpp>
#include <continuo/language/world.hpp>

namespace continuo::model::detail {

/// What a number of the world may be.
enum class Sort : unsigned char { any, positive, not_negative, fraction, slope };

/// Numbers that are held to their sort all at once.
struct ToJudge {
  NodeId node;
  Sort sort;
  Span span;
  std::string what;
};

/// How far the world is: what expressions may ask of it.
enum class Stage : unsigned char { declared, bodies_made, made };

struct WorldAtWork {
  Measured length = Measured::unknown(), mass = Measured::unknown();
  std::vector<std::string> groups{""};  // by number
  MaterialDescription material{};       // of what names none
  std::vector<ToJudge> to_judge{};
  WorldDescription made{};
  std::vector<std::size_t> joint_texts{};  // of made.joints, in WorldText::joints
  Stage stage = Stage::declared;
};

}  // namespace continuo::model::detail
