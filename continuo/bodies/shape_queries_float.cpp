// Instantiates the queries by shapes for single precision.
#include <continuo/bodies/queries/shape_query_members.hpp>

namespace continuo {

template Result<std::vector<RayHit<float, 2>>> Queries<float, 2>::first_contact(const PlacedShape<float, 2>&, const V&,
                                                                                const QueryFilter&) const;
template Result<Overlap> Queries<float, 2>::in_shape(const PlacedShape<float, 2>&, const QueryFilter&) const;
template Result<std::vector<NearSurface<float, 2>>> Queries<float, 2>::near_shape(const PlacedShape<float, 2>&,
                                                                                  const float&,
                                                                                  const QueryFilter&) const;
template Result<std::vector<RayHit<float, 3>>> Queries<float, 3>::first_contact(const PlacedShape<float, 3>&, const V&,
                                                                                const QueryFilter&) const;
template Result<Overlap> Queries<float, 3>::in_shape(const PlacedShape<float, 3>&, const QueryFilter&) const;
template Result<std::vector<NearSurface<float, 3>>> Queries<float, 3>::near_shape(const PlacedShape<float, 3>&,
                                                                                  const float&,
                                                                                  const QueryFilter&) const;

}  // namespace continuo
