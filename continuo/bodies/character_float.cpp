// Instantiates the motion of characters for single precision.
#include <continuo/bodies/queries/character_members.hpp>

namespace continuo {

template Status check(const CharacterOptions<float>&);
template Result<Character<float, 2>> walk(const World<float, 2>&, const Queries<float, 2>&, const Character<float, 2>&,
                                          const Vector<float, 2>&, const float&, const CharacterOptions<float>&);
template Result<Character<float, 3>> walk(const World<float, 3>&, const Queries<float, 3>&, const Character<float, 3>&,
                                          const Vector<float, 3>&, const float&, const CharacterOptions<float>&);

}  // namespace continuo
