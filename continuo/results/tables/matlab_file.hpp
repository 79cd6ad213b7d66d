// A table as a MATLAB file of version 5, which MATLAB, Octave and SciPy (scipy.io.loadmat) read:
//
//   >> S = load("ball.mat");  plot(S.t, S.h)
//
// One variable for each column, as a column vector, and an array for each family u[1..9], with the rows first. Names
// are those of MATLAB: x_dot for x', ball_1_x for ball[1].x. `column_names`, `column_units` and `column_variables` say
// which is which, `manifest` which run it is.
#pragma once
#include <string>
#include <vector>

#include <continuo/results/output_file.hpp>
#include <continuo/results/tables/stored_rows.hpp>
#include <continuo/simulation/run.hpp>
#include <continuo/status/status.hpp>

namespace continuo::results {

/// A name that MATLAB allows, and that none of `taken` has; it is added to these.
[[nodiscard]] std::string matlab_name(const std::string& name, std::vector<std::string>& taken);

/// Writes the file whole, with a few blocks of rows in memory. A variable has less than 2^31 bytes in this format.
Status write_matlab(OutputFile& out, const std::vector<model::Column>& columns, const std::string& manifest,
                    StoredRows& rows);

}  // namespace continuo::results
