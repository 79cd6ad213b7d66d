// Instantiates the queries of rays, regions and neighbours for double precision.
#include <continuo/bodies/queries/query_members.hpp>

namespace continuo {

template class Queries<double, 2>;
template class Queries<double, 3>;

}  // namespace continuo
