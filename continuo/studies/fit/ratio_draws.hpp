// Points to integrate over ratios of variances. Internal to fit.
#pragma once
#include <cstddef>
#include <vector>

#include <continuo/studies/fit/noise_ratios.hpp>

namespace continuo::studies::detail {

struct RatioDraws {
  std::vector<std::vector<double>> points;
  std::vector<double> weights;  // the sum is 1; not numbers where nothing is likely
  double effective = 0;         // how many draws of the distribution itself would be as good
};

/// One ratio is integrated over even places, several by a lattice whose density follows what each has by itself.
[[nodiscard]] RatioDraws draws_of(const NoiseRatios& ratios);

/// Of logarithms, so that the sum is 1; what is no number has no weight.
[[nodiscard]] std::vector<double> normalized(std::vector<double> logarithms);

}  // namespace continuo::studies::detail
