// The only file that includes netCDF.
#include <netcdf.h>

#include <continuo/results/netcdf_file.hpp>

namespace continuo::results {

namespace {

/// A file being written; after the first failure nothing more is tried.
class Writer {
 public:
  explicit Writer(const std::string& path) { note(nc_create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &file_)); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { close(); }

  int write(const NetcdfFile& file) {
    for (const NetcdfAttribute& attribute : file.attributes) put(NC_GLOBAL, attribute);
    std::vector<int> dimensions, variables;
    for (const NetcdfDimension& dimension : file.dimensions) dimensions.push_back(define(dimension));
    for (const NetcdfVariable& variable : file.variables) variables.push_back(define(variable, dimensions));
    if (good()) note(nc_enddef(file_));
    for (std::size_t k = 0; k < variables.size(); ++k)
      std::visit([&](const auto& values) { put(variables[k], values); }, file.variables[k].values);
    close();
    return status_;
  }

 private:
  bool good() const { return status_ == NC_NOERR; }
  void note(int status) {
    if (status != NC_NOERR && good()) status_ = status;
  }
  void close() {
    if (file_ >= 0) note(nc_close(file_));
    file_ = -1;
  }

  int define(const NetcdfDimension& dimension) {
    int id = -1;
    if (good()) note(nc_def_dim(file_, dimension.name.c_str(), dimension.size, &id));
    return id;
  }
  int define(const NetcdfVariable& variable, const std::vector<int>& dimensions) {
    std::vector<int> over;
    for (const std::size_t place : variable.dimensions) over.push_back(dimensions[place]);
    const bool texts = std::holds_alternative<NetcdfVariable::Texts>(variable.values);
    const int type = texts ? NC_STRING : variable.integers ? NC_INT : NC_DOUBLE;
    int id = -1;
    if (good()) note(nc_def_var(file_, variable.name.c_str(), type, static_cast<int>(over.size()), over.data(), &id));
    for (const NetcdfAttribute& attribute : variable.attributes) put(id, attribute);
    return id;
  }
  void put(int variable, const NetcdfAttribute& attribute) {
    const std::string& text = attribute.text;
    if (good() && !text.empty())
      note(nc_put_att_text(file_, variable, attribute.name.c_str(), text.size(), text.data()));
  }
  void put(int variable, const NetcdfVariable::Numbers& numbers) {
    if (!good()) return;
    const std::vector<double> values = numbers();
    if (!values.empty()) note(nc_put_var_double(file_, variable, values.data()));
  }
  void put(int variable, const NetcdfVariable::Texts& texts) {
    std::vector<const char*> pointers;
    for (const std::string& text : texts) pointers.push_back(text.c_str());
    if (good() && !pointers.empty()) note(nc_put_var_string(file_, variable, pointers.data()));
  }

  int file_ = -1, status_ = NC_NOERR;
};

}  // namespace

Status write_netcdf_file(const NetcdfFile& file, const std::string& path) {
  const int status = Writer(path).write(file);
  if (status == NC_NOERR) return {};
  return {.ending = Ending::unwritable, .message = "cannot write " + path + ": " + nc_strerror(status)};
}

}  // namespace continuo::results
