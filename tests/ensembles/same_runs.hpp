// Whether two results of a run have the same bits.
#pragma once
#include <cstddef>

#include <gtest/gtest.h>

#include <continuo/ensembles/ensemble.hpp>

namespace continuo::ensembles_test {

template <class X, class P>
void expect_same(const RunResult<X, P>& a, const RunResult<X, P>& b) {
  EXPECT_EQ(a.outcome.ending, b.outcome.ending);
  EXPECT_EQ(a.outcome.t, b.outcome.t);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.p, b.p);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.rejected, b.rejected);
  EXPECT_EQ(a.rows, b.rows);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].event, b.events[i].event);
    EXPECT_EQ(a.events[i].t, b.events[i].t);
    EXPECT_EQ(a.events[i].after, b.events[i].after);
  }
}

}  // namespace continuo::ensembles_test
