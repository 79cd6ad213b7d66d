// continuo_netcdf.so: the only part of the command that needs netCDF.
#include <continuo/results/netcdf_file.hpp>

extern "C" {
extern decltype(&continuo::results::write_netcdf_file) const continuo_module;
decltype(&continuo::results::write_netcdf_file) const continuo_module = &continuo::results::write_netcdf_file;
}
