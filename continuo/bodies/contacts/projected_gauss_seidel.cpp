// Instantiates the projected Gauss-Seidel iteration for the usual scalars and dimensions.
#include <continuo/bodies/contacts/projected_gauss_seidel.hpp>

namespace continuo {

template class ProjectedGaussSeidel<float, 2>;
template class ProjectedGaussSeidel<float, 3>;
template class ProjectedGaussSeidel<double, 2>;
template class ProjectedGaussSeidel<double, 3>;

}  // namespace continuo
