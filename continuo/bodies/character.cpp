// Instantiates the motion of characters for double precision.
#include <continuo/bodies/queries/character_members.hpp>

namespace continuo {

template Status check(const CharacterOptions<double>&);
template Result<Character<double, 2>> walk(const World<double, 2>&, const Queries<double, 2>&,
                                           const Character<double, 2>&, const Vector<double, 2>&, const double&,
                                           const CharacterOptions<double>&);
template Result<Character<double, 3>> walk(const World<double, 3>&, const Queries<double, 3>&,
                                           const Character<double, 3>&, const Vector<double, 3>&, const double&,
                                           const CharacterOptions<double>&);

}  // namespace continuo
