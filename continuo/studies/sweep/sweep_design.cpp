// Chooses the points of a sweep by the word that its text has for them.
#include <fmt/format.h>

#include <continuo/studies/sweep/sweep_design.hpp>

namespace continuo::studies {
namespace {

Sampling sampling_of(model::SweepSampling sampling) {
  if (sampling == model::SweepSampling::latin_hypercube) return Sampling::latin_hypercube;
  return sampling == model::SweepSampling::monte_carlo ? Sampling::monte_carlo : Sampling::sobol;
}

}  // namespace

Result<SweepDesign> SweepDesign::create(model::SweepSampling sampling, std::uint64_t runs, std::size_t dimensions,
                                        std::uint64_t seed) {
  if (sampling == model::SweepSampling::indices) {
    auto points = SobolPoints::create(
        {.factors = dimensions, .rows = sobol_rows(Sampling::sobol, dimensions, runs), .seed = seed});
    if (!points) return points.status();
    return SweepDesign(*std::move(points));
  }
  if (sampling == model::SweepSampling::morris) {
    const MorrisDesign design{.factors = dimensions, .trajectories = runs / (dimensions + 1), .seed = seed};
    if (Status status = check(design); !status) return status;
    return SweepDesign(design);
  }
  auto sampler = Sampler::create({sampling_of(sampling), runs, dimensions, seed});
  if (!sampler) return sampler.status();
  return SweepDesign(*std::move(sampler));
}

std::uint64_t SweepDesign::runs() const {
  if (const SobolDesign* design = indices()) return design->runs();
  if (const MorrisDesign* design = screening()) return design->runs();
  return std::get<Sampler>(points_).plan().runs;
}

double SweepDesign::at(std::uint64_t run, std::size_t dimension) const {
  if (const auto* points = std::get_if<SobolPoints>(&points_)) return points->at(run, dimension);
  if (const MorrisDesign* design = screening()) return coordinate(*design, run, dimension);
  return std::get<Sampler>(points_).at(run, dimension);
}

std::string SweepDesign::advice(std::uint64_t asked) const {
  if (const auto* sampler = std::get_if<Sampler>(&points_)) return studies::advice(sampler->plan());
  if (runs() == asked) return {};
  if (const SobolDesign* design = indices())
    return fmt::format("of {} runs {} are made: {} rows of {}, a power of two in each of {} samples", asked, runs(),
                       design->rows, design->factors + 2, design->replicates());
  return fmt::format("of {} runs {} are made: {} trajectories of {}", asked, runs(), screening()->trajectories,
                     screening()->factors + 1);
}

const SobolDesign* SweepDesign::indices() const {
  const auto* points = std::get_if<SobolPoints>(&points_);
  return points ? &points->design() : nullptr;
}

const MorrisDesign* SweepDesign::screening() const {
  return std::get_if<MorrisDesign>(&points_);
}

}  // namespace continuo::studies
