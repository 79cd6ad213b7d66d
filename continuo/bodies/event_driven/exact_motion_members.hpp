// continuo/bodies/event_driven/exact_motion_members.hpp
// Chooses the engine of an exact motion, and forwards calls to it.
#pragma once
#include <utility>

#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/forces.hpp>

namespace continuo {

template <class Real, int Dim>
auto ExactMotion<Real, Dim>::kind() const -> Kind {
  if (world_->has_solids() || world_->joint_count() > 0) return Kind::rigid;
  for (std::size_t i = 0; world_->has_traits() && i < world_->size(); ++i) {
    BodyTraits<Real> traits = world_->traits(i);
    traits.user_data = 0;
    if (traits != BodyTraits<Real>{}) return Kind::rigid;
  }
  return !companions_ && only_gravity(*world_) ? Kind::parabolic : Kind::constrained;
}
template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> ExactMotion<Real, Dim>::engine(Kind kind) const {
  if (kind == Kind::rigid) return rigid_motion(*world_, options_);
  if (kind == Kind::constrained) return constrained_motion(*world_, options_, companions_);
  if (world_->gravity == Vector<Real, Dim>{}) return event_driven(*world_, options_);
  return islands(*world_, options_);
}

template <class Real, int Dim>
ExactMotion<Real, Dim>::ExactMotion(World<Real, Dim>& world, const ExactOptions<Real>& options)
    : world_(&world), options_(options) {
  refresh();
}
template <class Real, int Dim>
ExactMotion<Real, Dim>::ExactMotion(World<Real, Dim>& world, const ExactOptions<Real>& options,
                                    Companions<Real, Dim>& companions)
    : world_(&world), companions_(&companions), options_(options) {
  refresh();
}
template <class Real, int Dim>
ExactMotion<Real, Dim>::ExactMotion(ExactMotion&&) noexcept = default;
template <class Real, int Dim>
ExactMotion<Real, Dim>& ExactMotion<Real, Dim>::operator=(ExactMotion&&) noexcept = default;
template <class Real, int Dim>
ExactMotion<Real, Dim>::~ExactMotion() = default;

template <class Real, int Dim>
Status ExactMotion<Real, Dim>::advance_to(const Real& t) {
  if (!(t >= world_->time) || !(t - t == Real(0)))
    return invalid_input("the time to advance to must be finite and not before the present");
  if (!(options_.tolerance > Real(0)) || !(options_.step >= Real(0)))
    return invalid_input("the tolerance must be greater than 0, and the step 0 or more");
  if (options_.contact_time && !(*options_.contact_time >= Real(0)))
    return invalid_input("contact_time must be 0 or more");
  if (Status fault = check_bodies(*world_); !fault) return fault;
  if (world_->has_meshes()) return invalid_input("the exact motion knows no static meshes: use FastMotion for them");
  if (kind() == Kind::rigid && companions_)
    return invalid_input("the exact motion integrates equations beside balls without joints only: use FastMotion");
  if (kind() != kind_) refresh();
  engine_->contacts.clear();
  return engine_->advance_to(t);
}
template <class Real, int Dim>
Status ExactMotion<Real, Dim>::step(const Real& h) {
  return advance_to(world_->time + h);
}
template <class Real, int Dim>
void ExactMotion<Real, Dim>::set_options(const ExactOptions<Real>& options) {
  options_ = options;
  refresh();
}
template <class Real, int Dim>
void ExactMotion<Real, Dim>::refresh() {
  const ExactStatistics so_far = engine_ ? engine_->statistics : ExactStatistics{};
  kind_ = kind();
  engine_ = engine(kind_);
  engine_->statistics = so_far;
}
template <class Real, int Dim>
const ExactStatistics& ExactMotion<Real, Dim>::statistics() const {
  return engine_->statistics;
}

template <class Real, int Dim>
std::span<const ContactEvent<Real, Dim>> ExactMotion<Real, Dim>::contact_events() const {
  return engine_->contacts.events();
}
template <class Real, int Dim>
std::size_t ExactMotion<Real, Dim>::lost_contact_events() const {
  return engine_->contacts.lost();
}

template <class Real, int Dim>
void ExactMotion<Real, Dim>::save(ByteWriter& writer) const {
  writer(engine_->statistics), writer(kind_);
  engine_->save(writer);
}
template <class Real, int Dim>
void ExactMotion<Real, Dim>::load(ByteReader& reader) {
  ExactStatistics statistics;
  Kind saved{};
  reader(statistics), reader(saved);
  reader.expect(saved == kind(), "a motion for other shapes, joints or forces than those of the world");
  if (!reader.ok()) return;
  auto next = engine(saved);
  next->load(reader);
  reader.expect_end();
  if (!reader.ok()) return;
  kind_ = saved;
  engine_ = std::move(next);
  engine_->statistics = statistics;
}

}  // namespace continuo
