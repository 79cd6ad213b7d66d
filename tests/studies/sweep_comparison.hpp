// Sweeps of models as text, and their outcomes compared bit by bit.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tests/symbolic/native_referee.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/native.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies {

inline PreparedSweep prepared_sweep(const std::string& text, model::Experiment experiment = {},
                                    std::shared_ptr<model::NativeCompiler> native = {}) {
  model::Loaded loaded = model::load(model::Source("model.sim", text));
  EXPECT_TRUE(loaded) << loaded.text() << text;
  loaded.model->native = std::move(native);
  auto made = PreparedSweep::create(*std::move(loaded.model), std::move(experiment));
  EXPECT_TRUE(made) << describe(made.status());
  return *std::move(made);
}

inline void expect_same_outcome(const SweepOutcome& actual, const SweepOutcome& expected) {
  EXPECT_EQ(actual.ending, expected.ending);
  EXPECT_EQ(model::bits(actual.t), model::bits(expected.t));
  EXPECT_EQ(actual.message, expected.message);
  ASSERT_EQ(actual.kept.size(), expected.kept.size());
  for (std::size_t k = 0; k < expected.kept.size(); ++k)
    EXPECT_EQ(model::bits(actual.kept[k]), model::bits(expected.kept[k]))
        << "kept " << k << ": " << actual.kept[k] << " for " << expected.kept[k];
}

}  // namespace continuo::studies
