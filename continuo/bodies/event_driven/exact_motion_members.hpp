// continuo/bodies/event_driven/exact_motion_members.hpp
// Chooses the engine of an exact motion, and forwards calls to it.
#pragma once
#include <utility>

#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/forces.hpp>

namespace continuo {

template <class Real, int Dim>
bool ExactMotion<Real, Dim>::is_parabolic() const {
  return !companions_ && only_gravity(*world_);
}
template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> ExactMotion<Real, Dim>::engine() const {
  if (!is_parabolic()) return constrained_motion(*world_, options_, companions_);
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
  if (world_->has_solids() || world_->joint_count() > 0)
    return invalid_input("the exact motion moves balls without joints: use FastMotion for other shapes and for joints");
  if (world_->has_meshes()) return invalid_input("the exact motion knows no static meshes: use FastMotion for them");
  for (std::size_t i = 0; world_->has_traits() && i < world_->size(); ++i) {
    BodyTraits<Real> traits = world_->traits(i);
    traits.user_data = 0;
    if (traits != BodyTraits<Real>{})
      return invalid_input("the exact motion knows no traits of bodies but user_data: use FastMotion");
  }
  if (is_parabolic() != was_parabolic_) refresh();
  engine_->contacts.clear();
  return engine_->advance_to(t);
}
template <class Real, int Dim>
void ExactMotion<Real, Dim>::refresh() {
  const ExactStatistics so_far = engine_ ? engine_->statistics : ExactStatistics{};
  was_parabolic_ = is_parabolic();
  engine_ = engine();
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
  writer(engine_->statistics), writer(was_parabolic_);
  engine_->save(writer);
}
template <class Real, int Dim>
void ExactMotion<Real, Dim>::load(ByteReader& reader) {
  ExactStatistics statistics;
  bool parabolic = false;
  reader(statistics), reader(parabolic);
  reader.expect(parabolic == is_parabolic(), "parabolas where there are other forces than gravity, or none where not");
  if (!reader.ok()) return;
  auto next = engine();
  next->load(reader);
  reader.expect_end();
  if (!reader.ok()) return;
  was_parabolic_ = parabolic;
  engine_ = std::move(next);
  engine_->statistics = statistics;
}

}  // namespace continuo
