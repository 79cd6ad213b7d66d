// continuo/results/netcdf.hpp
// A run as a netCDF file, for xarray and its like:
//
//   const Status status = write_netcdf(model, run, "gas.nc", hash);
//   if (!status) fmt::print(stderr, "{}\n", status.message);
//   >>> xarray.open_dataset("gas.nc").position.sel(component="x")          # (time, body)
//
// Dimensions: time; where the model has a world also body and component. Variables: time, position and velocity (time,
// body, component), angle (time, body), in space orientation (time, body, part), spin, radius and mass (body), and one
// (time) for every other column of the table, by its name; a family u[1..9] is one array (time, i), with its indices as
// the coordinate i. Each has `units` where the model says some (CF conventions 1.8).
#pragma once
#include <span>
#include <string>
#include <string_view>

#include <continuo/language/model.hpp>
#include <continuo/results/netcdf_file.hpp>
#include <continuo/simulation/run.hpp>
#include <continuo/status/status.hpp>

namespace continuo::results {

/// The variables of a run's rows, which have the sum of the energies behind their columns where there is one.
[[nodiscard]] NetcdfLayout netcdf_layout(const model::Model& model, const model::Plan& plan,
                                         std::span<const model::Column> columns, std::string_view manifest_hash);

/// What went wrong, if anything.
Status write_netcdf(const model::Model& model, const model::Run& run, const std::string& path,
                    std::string_view manifest_hash);

}  // namespace continuo::results
