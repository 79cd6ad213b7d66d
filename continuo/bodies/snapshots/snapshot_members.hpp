// continuo/bodies/snapshots/snapshot_members.hpp
// Writes a world and the internal state of its motion as bytes, and reads them back with every value checked. Compiled
// once for each kind of number.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/snapshot.hpp>
#include <continuo/bodies/snapshots/shape_members.hpp>

namespace continuo {

namespace detail::snapshots {

inline constexpr std::array<char, 8> magic{'c', 'o', 'n', 't', 'i', 'n', 'u', 'o'};

enum class Of : std::uint8_t { world, exact_motion, fast_motion };

template <class Real>
bool is_number(const Real& value) {
  return value - value == Real(0);
}
/// Whether this is a possible inverse of a mass or inertia, which is 0 for a fixed body.
template <class Real>
bool is_inverse(const Real& value) {
  return value >= Real(0) && is_number(value);
}

template <class Real>
void transfer(ByteReader& archive, Material<Real>& material) {
  archive(material.restitution), archive(material.friction), archive(material.rolling_resistance);
  archive.expect(static_cast<bool>(check(material)), "a material with values that none can have");
}
template <class Real>
void transfer(ByteWriter& archive, const Material<Real>& material) {
  archive(material.restitution), archive(material.friction), archive(material.rolling_resistance);
}

template <class Archive>
void transfer(Archive& archive, BodyHandle& body) {
  archive(body.slot), archive(body.generation);
}

template <class Archive, class Real, int Dim>
void transfer(Archive& archive, Wall<Real, Dim>& wall) {
  archive(wall.normal), archive(wall.offset), archive(wall.thin);
  transfer(archive, wall.material);
  if constexpr (Archive::reads) {
    archive.expect(std::abs(length(wall.normal) - 1) < Real(1e-3), "a wall whose normal is no unit");
    archive.expect(is_number(wall.offset), "a wall whose offset is not finite");
  }
}

template <class Archive, class Real, int Dim>
void transfer(Archive& archive, Spring<Real, Dim>& spring) {
  transfer(archive, spring.a);
  auto is_body = static_cast<std::uint8_t>(spring.b.index() == 0);
  archive(is_body);
  if constexpr (Archive::reads) {
    archive.expect(is_body <= 1, "a spring that ends at nothing known");
    if (is_body == 1) spring.b = BodyHandle{};
  }
  bool is_right = true;
  if (auto* const point = std::get_if<Vector<Real, Dim>>(&spring.b)) {
    archive(*point);
    is_right = is_finite(*point);
  } else {
    transfer(archive, std::get<BodyHandle>(spring.b));
  }
  archive(spring.rest_length), archive(spring.stiffness), archive(spring.damping);
  if constexpr (Archive::reads) {
    is_right = is_right && is_number(spring.rest_length) && is_number(spring.stiffness) && is_number(spring.damping);
    archive.expect(is_right, "a spring that is not finite");
  }
}

/// A list of parts that have a `transfer` here.
template <class Archive, class T>
void transfer_list(Archive& archive, std::vector<T>& values) {
  auto count = static_cast<std::uint64_t>(values.size());
  archive(count);
  if constexpr (Archive::reads) {
    if (count > archive.left()) return archive.fail("a list longer than the bytes that are left");
    values.clear();
    for (std::uint64_t i = 0; i < count && archive.ok(); ++i) transfer(archive, values.emplace_back());
  } else {
    for (T& value : values) transfer(archive, value);
  }
}

}  // namespace detail::snapshots

/// The private parts of a world.
struct SnapshotAccess {
  /// The shapes of bodies that are not balls, and joints.
  template <class Archive, class Real, int Dim>
  static void transfer_solids(Archive& archive, World<Real, Dim>& world) {
    auto solids = static_cast<std::uint64_t>(world.solids_.size());
    archive(solids);
    if constexpr (Archive::reads) {
      archive.expect(solids == 0 || solids == world.position.size(), "shapes of other bodies");
      if (!archive.ok()) return;
      world.solids_.assign(static_cast<std::size_t>(solids), nullptr);
      world.solid_count_ = 0;
    }
    for (auto& of_body : world.solids_) {
      Shape<Real, Dim> shape = of_body ? of_body->shape : Shape<Real, Dim>{};
      detail::snapshots::transfer_one_of(archive, shape);
      if constexpr (Archive::reads) {
        if (!archive.ok()) return;
        if (std::holds_alternative<Sphere<Real>>(shape)) continue;
        auto made = world.solid_of(shape);
        if (!made) return archive.fail(made.status().message);
        of_body = *made;
        ++world.solid_count_;
      }
    }
    detail::snapshots::transfer_list(archive, world.traits_);
    if constexpr (Archive::reads)
      archive.expect(world.traits_.empty() || world.traits_.size() == world.position.size(), "traits of other bodies");
    auto joints = static_cast<std::uint64_t>(world.joints_.size());
    archive(joints);
    if constexpr (Archive::reads) {
      if (joints > archive.left()) return archive.fail("a list longer than the bytes that are left");
      world.joints_.assign(static_cast<std::size_t>(joints), {});
      world.joint_count_ = 0;
    }
    for (auto& slot : world.joints_) {
      archive(slot.generation), archive(slot.is_used);
      detail::snapshots::transfer(archive, slot.joint);
      if constexpr (Archive::reads) world.joint_count_ += slot.is_used ? 1 : 0;
    }
  }

  template <class Archive, class Real, int Dim>
  static void transfer_meshes(Archive& archive, World<Real, Dim>& world) {
    auto meshes = static_cast<std::uint64_t>(world.meshes_.size());
    archive(meshes);
    if constexpr (Archive::reads) {
      if (meshes > archive.left()) return archive.fail("a list longer than the bytes that are left");
      world.meshes_.assign(static_cast<std::size_t>(meshes), {});
    }
    for (WorldMesh<Real, Dim>& mesh : world.meshes_) {
      bool is_there = mesh.geometry != nullptr;
      archive(mesh.generation), archive(is_there);
      if (!is_there) continue;
      MeshShape<Real, Dim> shape = mesh.geometry ? mesh.geometry->shape() : MeshShape<Real, Dim>{};
      detail::snapshots::transfer_one_of(archive, shape);
      detail::snapshots::transfer(archive, mesh.material);
      archive(mesh.category), archive(mesh.mask);
      if constexpr (Archive::reads) {
        if (!archive.ok()) return;
        auto made = StaticMesh<Real, Dim>::of(std::move(shape));
        if (!made) return archive.fail(made.status().message);
        mesh.geometry = std::make_shared<const StaticMesh<Real, Dim>>(std::move(*made));
      }
    }
  }

  template <class Archive, class Real, int Dim>
  static void transfer_world(Archive& archive, World<Real, Dim>& world) {
    archive(world.time), archive(world.gravity);
    archive(world.attraction.constant), archive(world.attraction.softening), archive(world.attraction.opening);
    archive(world.drag.linear), archive(world.drag.quadratic);
    for (Combine* how :
         {&world.combine_rule.restitution, &world.combine_rule.friction, &world.combine_rule.rolling_resistance}) {
      archive(*how);
      if constexpr (Archive::reads)
        archive.expect(*how <= Combine::geometric_mean, "materials that meet in no known way");
    }
    const auto laws_here = [&] { return world.force_laws.size() | std::uint64_t{world.torque_laws.size()} << 32; };
    std::uint64_t laws = laws_here();
    archive(laws);
    if constexpr (Archive::reads)
      archive.expect(laws == laws_here(), "the world that was saved had another number of laws of forces or torques");
    detail::snapshots::transfer_list(archive, world.springs);
    detail::snapshots::transfer_list(archive, world.walls_);
    archive(world.position), archive(world.velocity), archive(world.constant_force), archive(world.orientation);
    archive(world.spin), archive(world.radius), archive(world.mass), archive(world.inverse_mass);
    archive(world.inverse_inertia);
    detail::snapshots::transfer_list(archive, world.material);
    archive(world.group_), archive(world.slot_of_), archive(world.free_slots_);
    auto slots = static_cast<std::uint64_t>(world.slots_.size());
    archive(slots);
    if constexpr (Archive::reads) {
      if (slots > archive.left()) return archive.fail("a list longer than the bytes that are left");
      world.slots_.resize(static_cast<std::size_t>(slots));
    }
    for (auto& slot : world.slots_) archive(slot.index), archive(slot.generation);
    archive(world.ignored_);
    transfer_solids(archive, world);
    transfer_meshes(archive, world);
    if constexpr (Archive::reads) check(archive, world);
  }

 private:
  template <class Real, int Dim>
  static void check(ByteReader& archive, World<Real, Dim>& world) {
    if (!archive.ok()) return;
    const std::size_t n = world.position.size();
    bool are_as_many = true;
    world.for_each_array(world, [&](const auto& values) { are_as_many = are_as_many && values.size() == n; });
    if (!are_as_many) return archive.fail("bodies of which some parts are missing");
    archive.expect(detail::snapshots::is_number(world.time) && is_finite(world.gravity),
                   "a time or gravity that is not finite");
    for (const Real& value : {world.attraction.constant, world.attraction.softening, world.attraction.opening,
                              world.drag.linear, world.drag.quadratic})
      archive.expect(detail::snapshots::is_number(value), "a force that is not finite");
    for (std::size_t i = 0; i < n && archive.ok(); ++i)
      if (const char* fault = fault_of_body(world, i)) archive.fail("body " + std::to_string(i) + ": " + fault);
    std::size_t used = 0;
    for (const auto& slot : world.slots_) used += slot.index != World<Real, Dim>::nowhere ? 1 : 0;
    bool fit = used == n && world.free_slots_.size() + n == world.slots_.size();
    for (std::size_t i = 0; i < n && fit; ++i)
      fit = world.slot_of_[i] < world.slots_.size() && world.slots_[world.slot_of_[i]].index == i;
    std::vector<bool> is_free(world.slots_.size());
    for (const std::uint32_t slot : world.free_slots_) {
      fit = fit && slot < is_free.size() && !is_free[slot] && world.slots_[slot].index == World<Real, Dim>::nowhere;
      if (fit) is_free[slot] = true;
    }
    archive.expect(fit, "handles that do not fit the bodies");
  }
  template <class Real, int Dim>
  static const char* fault_of_body(const World<Real, Dim>& world, std::size_t i) {
    if (!is_finite(world.position[i]) || !is_finite(world.velocity[i]) || !is_finite(world.spin[i]) ||
        !is_finite(world.orientation[i]) || !is_finite(world.constant_force[i]))
      return "place, motion or force is not finite";
    if (!(world.radius[i] > Real(0)) || !detail::snapshots::is_number(world.radius[i]))
      return "the radius must be greater than 0";
    if (!(world.mass[i] > Real(0)) || !detail::snapshots::is_number(world.mass[i]))
      return "the mass must be greater than 0";
    if (!detail::snapshots::is_inverse(world.inverse_mass[i]) ||
        !detail::snapshots::is_inverse(world.inverse_inertia[i]) ||
        (world.inverse_mass[i] > Real(0)) != (world.inverse_inertia[i] > Real(0)))
      return "the inverse of the mass must be that of a body that moves, or 0";
    return world.group_[i] < 32 ? nullptr : "groups are numbered from 0 to 31";
  }
};

namespace detail::snapshots {

template <class Real, int Dim, class WriteMotion>
Bytes written(const World<Real, Dim>& world, Of of, WriteMotion&& write_motion) {
  ByteWriter writer;
  writer(magic), writer(snapshot_version), writer(static_cast<std::uint8_t>(sizeof(Real)));
  writer(static_cast<std::uint8_t>(Dim)), writer(of);
  SnapshotAccess::transfer_world(writer, const_cast<World<Real, Dim>&>(world));  // a writer only reads it
  write_motion(writer);
  writer(checksum(writer.bytes()));
  return writer.take();
}

/// Bytes that cannot be read.
inline Status corrupt(std::string message) {
  return {.ending = Ending::unreadable, .message = std::move(message)};
}

/// Reads the head and the world; read_motion(reader, of, found) then reads the rest and gets the world that was read.
template <class Real, int Dim, class ReadMotion>
Status read(std::span<const std::byte> bytes, World<Real, Dim>& world, ReadMotion&& read_motion) {
  if (bytes.size() < sizeof(std::uint64_t)) return corrupt("byte 0: too short for a snapshot");
  const std::span<const std::byte> body = bytes.first(bytes.size() - sizeof(std::uint64_t));
  ByteReader reader(body);
  std::array<char, 8> name{};
  std::uint32_t version = 0;
  std::uint8_t size = 0, dim = 0;
  Of of{};
  reader(name);
  reader.expect(name == magic, "this is no snapshot");
  reader(version);
  reader.expect(version == snapshot_version, "a snapshot of another version");
  reader(size), reader(dim), reader(of);
  reader.expect(size == sizeof(Real), "numbers of another size: float and double worlds do not mix");
  reader.expect(dim == Dim, "another number of dimensions");
  reader.expect(of <= Of::fast_motion, "a snapshot of nothing known");
  if (!reader.ok()) return reader.status();
  std::uint64_t sum = 0;
  ByteReader(bytes.last(sizeof sum))(sum);
  if (sum != checksum(body))
    return corrupt("byte " + std::to_string(body.size()) + ": the checksum does not fit the bytes");
  World<Real, Dim> found;
  found.force_laws = world.force_laws;
  found.torque_laws = world.torque_laws;
  SnapshotAccess::transfer_world(reader, found);
  if (reader.ok()) read_motion(reader, of, found);
  return reader.status();
}

}  // namespace detail::snapshots

template <class Real, int Dim>
Bytes snapshot(const World<Real, Dim>& world) {
  return detail::snapshots::written(world, detail::snapshots::Of::world, [](ByteWriter&) {});
}
template <class Real, int Dim>
Bytes snapshot(const World<Real, Dim>& world, const ExactMotion<Real, Dim>& motion) {
  return detail::snapshots::written(world, detail::snapshots::Of::exact_motion,
                                    [&](ByteWriter& writer) { motion.save(writer); });
}
template <class Real, int Dim>
Bytes snapshot(const World<Real, Dim>& world, const FastMotion<Real, Dim>& motion) {
  return detail::snapshots::written(world, detail::snapshots::Of::fast_motion,
                                    [&](ByteWriter& writer) { motion.save(writer); });
}

template <class Real, int Dim>
Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world) {
  return detail::snapshots::read(bytes, world,
                                 [&](ByteReader& reader, detail::snapshots::Of of, World<Real, Dim>& found) {
                                   if (of == detail::snapshots::Of::world) reader.expect_end();
                                   if (reader.ok()) world = std::move(found);
                                 });
}

namespace detail::snapshots {

template <class Real, int Dim, class Motion>
Status restore_both(std::span<const std::byte> bytes, World<Real, Dim>& world, Motion& motion, Of expected) {
  return read(bytes, world, [&](ByteReader& reader, Of of, World<Real, Dim>& found) {
    if (of != expected) return reader.fail("a snapshot without this motion");
    std::swap(world, found);
    motion.load(reader);
    if (reader.ok()) return;
    std::swap(world, found);  // the motion is as it was
  });
}

}  // namespace detail::snapshots

template <class Real, int Dim>
Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world, ExactMotion<Real, Dim>& motion) {
  return detail::snapshots::restore_both(bytes, world, motion, detail::snapshots::Of::exact_motion);
}
template <class Real, int Dim>
Status restore(std::span<const std::byte> bytes, World<Real, Dim>& world, FastMotion<Real, Dim>& motion) {
  return detail::snapshots::restore_both(bytes, world, motion, detail::snapshots::Of::fast_motion);
}

}  // namespace continuo
