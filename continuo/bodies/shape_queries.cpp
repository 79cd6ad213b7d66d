// Instantiates the queries by shapes for double precision.
#include <continuo/bodies/queries/shape_query_members.hpp>

namespace continuo {

template Result<std::vector<RayHit<double, 2>>> Queries<double, 2>::first_contact(const PlacedShape<double, 2>&,
                                                                                  const V&, const QueryFilter&) const;
template Result<Overlap> Queries<double, 2>::in_shape(const PlacedShape<double, 2>&, const QueryFilter&) const;
template Result<std::vector<NearSurface<double, 2>>> Queries<double, 2>::near_shape(const PlacedShape<double, 2>&,
                                                                                    const double&,
                                                                                    const QueryFilter&) const;
template Result<std::vector<RayHit<double, 3>>> Queries<double, 3>::first_contact(const PlacedShape<double, 3>&,
                                                                                  const V&, const QueryFilter&) const;
template Result<Overlap> Queries<double, 3>::in_shape(const PlacedShape<double, 3>&, const QueryFilter&) const;
template Result<std::vector<NearSurface<double, 3>>> Queries<double, 3>::near_shape(const PlacedShape<double, 3>&,
                                                                                    const double&,
                                                                                    const QueryFilter&) const;

}  // namespace continuo
