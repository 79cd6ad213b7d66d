// Instantiates the queries of rays, regions and neighbours for single precision.
#include <continuo/bodies/queries/query_members.hpp>

namespace continuo {

template class Queries<float, 2>;
template class Queries<float, 3>;

}  // namespace continuo
