// continuo/numerics/banded_lu.cpp
// Written out for every width, therefore compiled once.
#include <continuo/numerics/banded_lu.hpp>

namespace continuo {

template class BandedLU<double>;
template class BandedLU<ComplexNumber<double>>;

}  // namespace continuo
