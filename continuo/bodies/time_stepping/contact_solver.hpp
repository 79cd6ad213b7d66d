// Contacts of two spheres, or of a sphere and a wall, as soft constraints on velocities, several at once: E. Catto,
// "Soft constraints" (GDC 2011) and "Solver2D" (2024), sequential impulses with bias, relaxation and warm starting.
//
// With s the separation and v the normal velocity, a substep of h wants v = -s / h where the two are apart (they may
// close the gap and no more), and where they overlap the impulse of a spring of angular frequency w and damping ratio
// z,
//
//   lambda = -m (v + rate s) scale_of_mass - scale_of_impulse lambda_so_far,
//   a1 = 2 z + h w, a2 = h w a1, rate = w / a1, scale_of_mass = a2 / (1 + a2), scale_of_impulse = 1 / (1 + a2),
//
// which is stable at any stiffness. Between spheres the arms lie along the normal: a normal impulse turns nothing, and
// what resists across the normal is a number, 1/m1 + 1/m2 + r1^2/J1 + r2^2/J2. Friction acts across the normal, so the
// normal velocity is the same before and after it and both impulses are added at once.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <continuo/bodies/time_stepping/contact_torques.hpp>

namespace continuo {

template <class Real>
struct Softness {
  Real rate = Real(0), of_mass = Real(1), of_impulse = Real(0);
};

/// `hertz` the frequency of the contact, `damping` its ratio z, `h` the substep.
template <class Real>
Softness<Real> softness(const Real& hertz, const Real& damping, const Real& h) {
  const Real w = 2 * std::numbers::pi_v<Real> * hertz, a1 = 2 * damping + h * w, a2 = h * w * a1;
  return {w / a1, a2 / (1 + a2), 1 / (1 + a2)};
}

/// How the contacts of a substep are solved.
template <class Real>
struct ContactStep {
  Real h{};
  Softness<Real> soft{};
  Real fastest_push{};      // with which an overlap is undone at most
  bool may_strike = false;  // impacts were looked for: what they are for is no business of a soft contact
  Real greatest_acceleration{};
  Real friction{};         // where all have the same
  Real disturbance{};      // a change of velocity that makes so long a way in a substep is one
  std::uint8_t sweep = 1;  // of those that push; after the first only what was disturbed is pushed again
};

/// Undo overlaps; do so again where neighbours disturbed it; take out the velocity that this gave.
enum class ContactPass { push, push_again, relax };

/// An impulse on b where it touches, its opposite on a; `rub` is the part of it across the normal.
template <class Real, int Dim>
void add_impulse(LaneMotions<Real, Dim>& a, LaneMotions<Real, Dim>& b, const Vector<ContactLanes<Real>, Dim>& normal,
                 const Vector<ContactLanes<Real>, Dim>& impulse, const Vector<ContactLanes<Real>, Dim>& rub) {
  a.v -= impulse * a.inverse_mass;
  b.v += impulse * b.inverse_mass;
  const Spin<ContactLanes<Real>, Dim> twist = moment(normal, rub);
  a.rim -= twist * a.mobility;
  b.rim -= twist * b.mobility;
}
/// `impulse`, its part across the normal no longer than `most`; what lies along that, in space, resists spinning, and
/// stays.
template <class Real, int Dim>
Vector<ContactLanes<Real>, Dim> clamped_across(const Vector<ContactLanes<Real>, Dim>& impulse,
                                               const Vector<ContactLanes<Real>, Dim>& normal,
                                               const ContactLanes<Real>& most) {
  using std::sqrt;
  using L = ContactLanes<Real>;
  if constexpr (Dim == 2) return clamped(impulse, most);
  const L along = dot(impulse, normal), square = squared(impulse) - along * along, one(Real(1));
  const L part = select(square > most * most, most / sqrt(square), one);
  return impulse * part + normal * (along * (one - part));
}

/// Where the two are now, and the impulses of the last substep to begin with: all contacts do so before any is solved,
/// for each must see what the others carry.
template <ContactKind kind, class Real, int Dim>
void begin(ColouredBatches<Real, Dim>& batches, std::size_t p, SolverBodies<Real, Dim>& bodies) {
  ContactBatch<Real, Dim>& batch = batches.batches[p];
  BatchImpulses<Real, Dim>& impulses = batches.impulses[p];
  using L = ContactLanes<Real>;
  using std::sqrt;
  const auto place_a = load_places(bodies, batch.a), place_b = load_places(bodies, batch.b);
  const Vector<L, Dim> apart = place_b.x - place_a.x;
  Vector<L, Dim> normal = loaded(batch.normal);
  if constexpr (kind == ContactKind::with_wall) {
    batch.separation = dot(apart, normal) - place_a.radius;
  } else {
    const L distance = sqrt(squared(apart));
    const auto are_apart = distance > L(Real(0));
    normal = apart * select(are_apart, L(Real(1)) / distance, L(Real(0)));
    normal[0] = select(are_apart, normal[0], L(Real(1)));  // any direction will do
    store(normal, batch.normal);
    batch.separation = distance - (place_a.radius + place_b.radius);
  }
  // What friction did along the normal of then is not along that of now: in space a little of it becomes a torque.
  Vector<L, Dim> rub = loaded(impulses.friction);
  const L along = dot(rub, normal);
  rub -= normal * along;
  if constexpr (Dim == 2) store(rub, impulses.friction);
  auto a = load_motions(bodies, batch.a), b = load_motions(bodies, batch.b);
  add_impulse<Real, Dim>(a, b, normal, normal * L(impulses.normal) + rub, rub);
  if constexpr (Dim == 3)
    add_spin<Real>(a, b, normal, place_a.radius, other_radius<kind, Real>(place_a.radius, place_b.radius), along);
  if (const auto* special = batches.special_material_of(p))
    add_roll<Real, Dim>(a, b, place_a.radius, place_b.radius, loaded(special->rolling_impulse));
  store_motions(a, bodies, batch.a);
  if constexpr (kind == ContactKind::between_movers) store_motions(b, bodies, batch.b);
}

/// Too fast for a soft contact: it has struck in this substep and parts, or it will at the beginning of the next.
/// What gravity alone brings about in a substep is no impact; nor is, without restitution, what moves it by less than
/// half a radius; nor what comes about, while contacts are solved, between two that have touched since it began: in
/// the end it may be slower than an impact is, and then nothing would hold them apart. What has struck begins so far
/// behind where it did, perhaps, that it comes from the other side of the other.
template <class Real, int Dim>
typename ContactLanes<Real>::Mask is_for_impacts(const ContactBatch<Real, Dim>& batch,
                                                 const ContactLanes<Real>& restitution,
                                                 const SolverBodies<Real, Dim>& bodies,
                                                 const ContactLanes<Real>& separation,
                                                 const ContactLanes<Real>& parting,
                                                 const typename ContactLanes<Real>::Mask& parts_in_the_end,
                                                 const ContactLanes<Real>& radius, const ContactStep<Real>& step) {
  using L = ContactLanes<Real>;
  const L zero(Real(0));
  if (!step.may_strike) return typename L::Mask(false);
  std::array<Real, lanes_at_once<Real>> struck{};
  for (std::size_t lane = 0; lane < struck.size(); ++lane) {
    const auto of = [&](std::uint32_t i) { return i < bodies.size() ? bodies.impacts[i] : 0u; };
    struck[lane] = of(batch.a[lane]) + of(batch.b[lane]) > 0 ? Real(1) : Real(0);
  }
  const auto has_struck = (L(struck) > zero) & (separation < zero) & ((parting > zero) | parts_in_the_end);
  const L approach = -parting;
  const auto bounces = restitution > zero;
  const auto will_strike = (bounces & (approach > L(4 * step.greatest_acceleration * step.h))) |
                           ((!bounces) & (approach * L(step.h) > radius * L(Real(0.5))));
  return has_struck | (will_strike & (L(batch.separation) > zero));
}

template <ContactKind kind, class Real, int Dim>
void mark_touched(const ContactBatch<Real, Dim>& batch, const BatchImpulses<Real, Dim>& impulses,
                  SolverBodies<Real, Dim>& bodies) {
  for (std::size_t lane = 0; lane < lanes_at_once<Real>; ++lane) {
    const auto is_pressed = static_cast<std::uint8_t>(impulses.normal.lane[lane] > Real(0));
    bodies.touched[batch.a[lane]] |= is_pressed;  // no branch: nobody could foresee it
    if (kind == ContactKind::between_movers) bodies.touched[batch.b[lane]] |= is_pressed;
  }
}

/// 1 in the lanes of bodies that the last sweep, or this one, disturbed.
template <class Real, int Dim>
std::array<Real, lanes_at_once<Real>> disturbed_lanes(const ContactBatch<Real, Dim>& batch,
                                                      const SolverBodies<Real, Dim>& bodies, std::uint8_t sweep) {
  std::array<Real, lanes_at_once<Real>> is{};
  for (std::size_t lane = 0; lane < is.size(); ++lane)
    is[lane] =
        static_cast<Real>(std::max(bodies.disturbed[batch.a[lane]], bodies.disturbed[batch.b[lane]]) + 1 >= sweep);
  return is;
}
template <ContactKind kind, class Real, int Dim>
void mark_disturbed(const ContactBatch<Real, Dim>& batch, const ContactLanes<Real>& change,
                    SolverBodies<Real, Dim>& bodies, const ContactStep<Real>& step) {
  using L = ContactLanes<Real>;
  const L way = abs(change) * L(step.h);
  if (all(way <= L(step.disturbance))) return;
  for (std::size_t lane = 0; lane < lanes_at_once<Real>; ++lane) {
    if (way[lane] <= step.disturbance) continue;
    const auto mark = [&](std::uint32_t body) {
      bodies.disturbed[body] = step.sweep;
      const ContactBlocks& blocks = bodies.blocks;
      bodies.disturbances[body / blocks.half].now |= 1u << blocks.bin_of(body % blocks.half);
    };
    mark(batch.a[lane]);
    if (kind == ContactKind::between_movers) mark(batch.b[lane]);
  }
}

template <ContactKind kind, ContactPass pass, bool is_plain, class Real, int Dim>
void solve(ColouredBatches<Real, Dim>& batches, std::size_t p, SolverBodies<Real, Dim>& bodies,
           const ContactStep<Real>& step) {
  using L = ContactLanes<Real>;
  const ContactBatch<Real, Dim>& batch = batches.batches[p];
  BatchImpulses<Real, Dim>& impulses = batches.impulses[p];
  [[maybe_unused]] SpecialMaterialBatch<Real, Dim>* const special = is_plain ? nullptr : batches.special_material_of(p);
  const L zero(Real(0)), one(Real(1));
  typename L::Mask is_meant(true);
  if constexpr (pass == ContactPass::push_again) {
    is_meant = L(disturbed_lanes(batch, bodies, step.sweep)) > zero;
    if (none(is_meant)) return;
  }
  auto a = load_motions(bodies, batch.a), b = load_motions(bodies, batch.b);
  const Vector<L, Dim> normal = loaded(batch.normal);
  const L so_far = impulses.normal;
  L separation = batch.separation, radius_a, radius_b;
  Vector<L, Dim> apart;
  if (pass == ContactPass::relax || !is_plain) {
    const auto place_a = load_places(bodies, batch.a), place_b = load_places(bodies, batch.b);
    radius_a = place_a.radius;
    radius_b = place_b.radius;
    apart = place_b.x - place_a.x;
    if (pass == ContactPass::relax) separation = dot(apart, normal) - (radius_a + radius_b);
  }
  if constexpr (!is_plain && pass != ContactPass::push_again)
    if (special) resist_rolling(*special, so_far, a, b, radius_a, radius_b);

  const Vector<L, Dim> between = b.v - a.v;
  const L speed = dot(between, normal), inverse = a.inverse_mass + b.inverse_mass;
  const Vector<L, Dim> slip = between - turning(Spin<L, Dim>(a.rim + b.rim), normal) - normal * speed;
  L coefficient(step.friction);
  if constexpr (!is_plain)
    if (special) coefficient = special->friction;
  const Vector<L, Dim> friction_before = loaded(impulses.friction);
  Vector<L, Dim> friction = clamped_across<Real, Dim>(
      friction_before - slip * (one / (inverse + a.mobility + b.mobility)), normal, coefficient * so_far);

  const auto is_open = separation > zero;
  L bias = select(is_open, separation * L(1 / step.h), zero), of_mass = one, of_impulse = zero;
  if constexpr (pass != ContactPass::relax) {
    bias = select(is_open, bias, max(separation * L(step.soft.rate), L(-step.fastest_push)));
    of_mass = select(is_open, one, L(step.soft.of_mass));
    of_impulse = select(is_open, zero, L(step.soft.of_impulse));
  }
  L normal_impulse = max(so_far - (speed + bias) * of_mass / inverse - of_impulse * so_far, zero);
  L change = normal_impulse - so_far;
  Vector<L, Dim> rub = friction - friction_before;
  const auto leave = [&](const typename L::Mask& these, const L& impulse, const Vector<L, Dim>& rubbed) {
    normal_impulse = select(these, impulse, normal_impulse);
    change = select(these, zero, change);
    for (std::size_t axis = 0; axis < rub.size(); ++axis) {
      friction[axis] = select(these, rubbed[axis], friction[axis]);
      rub[axis] = select(these, zero, rub[axis]);
    }
  };
  if constexpr (!is_plain) {
    const L restitution = special ? L(special->restitution) : zero;
    const Vector<L, Dim> at_end = pass == ContactPass::relax ? apart : Vector<L, Dim>(apart + between * L(step.h));
    const auto parts_in_the_end =
        kind == ContactKind::with_wall ? typename L::Mask(false) : dot(at_end, between) > zero;
    leave(is_for_impacts<Real, Dim>(batch, restitution, bodies, separation, speed, parts_in_the_end,
                                    smaller_radius<Real>(radius_a, radius_b), step),
          zero, {});
  }
  if constexpr (pass == ContactPass::push_again) leave(!is_meant, so_far, friction_before);
  impulses.normal = normal_impulse;
  add_impulse<Real, Dim>(a, b, normal, rub + normal * change, rub);
  if constexpr (pass == ContactPass::relax && Dim == 3)
    friction += normal * resist_spinning<Real>(dot(friction, normal), coefficient * normal_impulse, normal, a, b,
                                               radius_a, other_radius<kind, Real>(radius_a, radius_b));
  store(friction, impulses.friction);
  store_motions(a, bodies, batch.a);
  if constexpr (kind == ContactKind::between_movers) store_motions(b, bodies, batch.b);
  if constexpr (pass != ContactPass::relax) {
    mark_touched<kind>(batch, impulses, bodies);
    mark_disturbed<kind>(batch, change * inverse, bodies, step);
  }
}

// Loops over batches. Everything is inlined into them, for a call would send registers full of lanes through memory.

/// Asks for a batch that is soon to come, and for the bodies of one that is: they lie where they lie.
template <class Pack>
void prefetch_lines(const Pack& batch) {
  constexpr std::size_t line = 64;
  const auto* bytes = reinterpret_cast<const std::byte*>(&batch);
  for (std::size_t at = 0; at < sizeof(Pack); at += line) __builtin_prefetch(bytes + at);
}
template <class Real, int Dim>
void prefetch_bodies(const ContactBatch<Real, Dim>& batch, const SolverBodies<Real, Dim>& bodies) {
  for (std::size_t lane = 0; lane < lanes_at_once<Real>; ++lane) {
    __builtin_prefetch(&bodies.motion[batch.a[lane]]);
    __builtin_prefetch(&bodies.motion[batch.b[lane]]);
    __builtin_prefetch(&bodies.place[batch.a[lane]]);
    __builtin_prefetch(&bodies.place[batch.b[lane]]);
  }
}
/// number(i) for i = 0 ... count - 1 are those of batches.
template <class Real, int Dim, class Number, class Act>
void for_each_ahead(const ColouredBatches<Real, Dim>& batches, const SolverBodies<Real, Dim>& bodies, std::size_t count,
                    const Number& number, const Act& act) {
  constexpr std::size_t ahead = 3;
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 2 * ahead < count) {
      prefetch_lines(batches.batches[number(i + 2 * ahead)]);
      prefetch_lines(batches.impulses[number(i + 2 * ahead)]);
    }
    if (i + ahead < count) prefetch_bodies(batches.batches[number(i + ahead)], bodies);
    act(number(i));
  }
}
/// Those of a group in which the last sweep, or this one, disturbed anything. Packs of a colour share no body, so that
/// which ones are meant can be seen before the first of them is solved; those of the shared one are few.
template <class Real, int Dim, class Act>
void for_each_disturbed(const ColouredBatches<Real, Dim>& batches, std::size_t group,
                        const SolverBodies<Real, Dim>& bodies, const Act& act) {
  if (bodies.disturbed_bins(group) == 0) return;
  const auto& first = batches.groups[group].first;
  std::array<std::uint32_t, 256> meant;
  for (std::size_t c = 0; c < batches.most_colours && first[c] < first.back(); ++c)
    for (std::size_t from = first[c]; from < first[c + 1]; from += meant.size()) {
      const std::uint64_t bins = batches.is_shared(c) ? ~std::uint64_t{0} : bodies.disturbed_bins(group);
      const std::size_t to = std::min<std::size_t>(from + meant.size(), first[c + 1]);
      std::size_t count = 0;
      for (std::size_t p = from; p < to; ++p) {
        meant[count] = static_cast<std::uint32_t>(p);
        count += (batches.bins[p] & bins) != 0;  // no branch: nobody could foresee it
      }
      for_each_ahead(batches, bodies, count, [&](std::size_t i) { return meant[i]; }, act);
    }
}

template <ContactKind kind, class Real, int Dim>
[[gnu::flatten]] void begin_batches(ColouredBatches<Real, Dim>& batches, std::size_t group,
                                    SolverBodies<Real, Dim>& bodies) {
  const std::size_t from = batches.groups[group].first.front(), to = batches.groups[group].first.back();
  for_each_ahead(
      batches, bodies, to - from, [&](std::size_t i) { return from + i; },
      [&](std::size_t p) { begin<kind>(batches, p, bodies); });
}
template <ContactKind kind, ContactPass pass, class Real, int Dim>
[[gnu::flatten]] void solve_batches(ColouredBatches<Real, Dim>& batches, std::size_t group,
                                    SolverBodies<Real, Dim>& bodies, const ContactStep<Real>& of_all) {
  const ContactStep<Real> step = of_all;  // a copy, which no store to a body can change: it stays in registers
  const auto for_each = [&](const auto& act) {
    const std::size_t from = batches.groups[group].first.front(), to = batches.groups[group].first.back();
    if constexpr (pass == ContactPass::push_again) {
      for_each_disturbed(batches, group, bodies, act);
    } else {
      for_each_ahead(batches, bodies, to - from, [&](std::size_t i) { return from + i; }, act);
    }
  };
  if (batches.special.empty() && !step.may_strike) {
    for_each([&](std::size_t p) { solve<kind, pass, true>(batches, p, bodies, step); });
  } else {
    for_each([&](std::size_t p) { solve<kind, pass, false>(batches, p, bodies, step); });
  }
}

}  // namespace continuo
