// Writes and reads the shapes, static meshes and joints of a world, with every value checked.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <continuo/bodies/joint.hpp>
#include <continuo/bodies/mesh.hpp>
#include <continuo/bodies/support/bytes.hpp>

namespace continuo::detail::snapshots {

template <class Archive, class Real>
void transfer(Archive& archive, Sphere<Real>& sphere) {
  archive(sphere.radius);
}
template <class Archive, class Real>
void transfer(Archive& archive, Capsule<Real>& capsule) {
  archive(capsule.length), archive(capsule.radius);
}
template <class Archive, class Real, int Dim>
void transfer(Archive& archive, Box<Real, Dim>& box) {
  archive(box.size), archive(box.rounding);
}
template <class Archive, class Real, int Dim>
void transfer(Archive& archive, Hull<Real, Dim>& hull) {
  archive(hull.points), archive(hull.rounding);
}
template <class Archive, class Value, class Transfer>
void transfer_optional(Archive& archive, std::optional<Value>& value, Transfer&& transfer_value) {
  bool is_there = value.has_value();
  archive(is_there);
  if constexpr (Archive::reads) value = is_there ? std::optional<Value>(Value{}) : std::nullopt;
  if (value) transfer_value(*value);
}
template <class Archive, class Real>
void transfer(Archive& archive, Chain<Real>& chain) {
  archive(chain.points), archive(chain.is_loop), archive(chain.is_two_sided);
  transfer_optional(archive, chain.before, archive);
  transfer_optional(archive, chain.after, archive);
}
template <class Archive, class Real>
void transfer(Archive& archive, TriangleMesh<Real>& mesh) {
  archive(mesh.corners), archive(mesh.triangles), archive(mesh.is_two_sided);
}
template <class Archive, class Real, int Dim>
void transfer(Archive& archive, HeightField<Real, Dim>& field) {
  archive(field.origin), archive(field.spacing), archive(field.counts), archive(field.heights);
}
template <class Archive, class Real, int Dim>
void transfer(Archive& archive, Compound<Real, Dim>& compound);

/// Which of the types of a variant it has, and its value.
template <class Archive, class... Types>
void transfer_one_of(Archive& archive, std::variant<Types...>& value) {
  auto kind = static_cast<std::uint8_t>(value.index());
  archive(kind);
  if constexpr (Archive::reads) {
    archive.expect(kind < sizeof...(Types), "a shape of no known kind");
    if (!archive.ok()) return;
    std::uint8_t k = 0;
    ((k++ == kind ? void(value = Types{}) : void()), ...);
  }
  std::visit([&](auto& of) { transfer(archive, of); }, value);
}

template <class Archive, class Real, int Dim>
void transfer(Archive& archive, Compound<Real, Dim>& compound) {
  auto count = static_cast<std::uint64_t>(compound.parts.size());
  archive(count);
  if constexpr (Archive::reads) {
    if (count > archive.left()) return archive.fail("a list longer than the bytes that are left");
    compound.parts.assign(static_cast<std::size_t>(count), {});
  }
  for (ShapePart<Real, Dim>& part : compound.parts) {
    transfer_one_of(archive, part.shape);
    archive(part.position), archive(part.orientation);
  }
}
template <class Archive, class Real>
void transfer(Archive& archive, BodyTraits<Real>& traits) {
  archive(traits.is_driven), archive(traits.is_sensor), archive(traits.locked), archive(traits.gravity_scale);
  archive(traits.damping), archive(traits.spin_damping), archive(traits.category), archive(traits.mask);
  archive(traits.user_data);
  if constexpr (Archive::reads)
    archive.expect(static_cast<unsigned>(traits.locked) < 64 && std::isfinite(traits.gravity_scale) &&
                       traits.damping >= Real(0) && traits.spin_damping >= Real(0),
                   "traits that no body can have");
}

/// The indices of bodies are checked by their handles, when the joint is used.
template <class Archive, class Real, int Dim>
void transfer(Archive& archive, Joint<Real, Dim>& joint) {
  archive(joint.kind);
  if constexpr (Archive::reads) archive.expect(joint.kind <= JointKind::pull, "a joint of no known kind");
  archive(joint.a.slot), archive(joint.a.generation), archive(joint.b.slot), archive(joint.b.generation);
  archive(joint.anchor_a), archive(joint.anchor_b);
  for (auto* const axes : {&joint.axes_a, &joint.axes_b})
    for (auto& axis : axes->columns) archive(axis);
  archive(joint.start), archive(joint.length), archive(joint.target), archive(joint.ratio);
  transfer_optional(archive, joint.limits, [&](auto& of) { archive(of.lower), archive(of.upper); });
  transfer_optional(archive, joint.spring, [&](auto& of) { archive(of.hertz), archive(of.damping), archive(of.rest); });
  transfer_optional(archive, joint.motor, [&](auto& of) { archive(of.speed), archive(of.most); });
  archive(joint.breaks_at), archive(joint.breaks_at_torque), archive(joint.collide), archive(joint.is_broken);
  archive(joint.force), archive(joint.torque), archive(joint.motor_effort);
  if constexpr (Archive::reads) {
    const auto are_finite = [](const auto&... vectors) { return (is_finite(vectors) && ...); };
    bool is_right = are_finite(joint.anchor_a, joint.anchor_b, joint.start, joint.target);
    for (const auto* const axes : {&joint.axes_a, &joint.axes_b})
      for (const auto& axis : axes->columns) is_right = is_right && std::abs(length(axis) - 1) < Real(1e-3);
    archive.expect(is_right && std::isfinite(joint.length) && std::isfinite(joint.ratio), "a joint that is not finite");
    archive.expect(joint.kind != JointKind::pull || joint.a == BodyHandle{}, "a pull with two bodies");
  }
}

}  // namespace continuo::detail::snapshots
