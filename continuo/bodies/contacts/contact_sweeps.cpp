#include <continuo/bodies/contacts/contact_sweeps.hpp>

namespace continuo {

template class ContactSweeps<float, 2>;
template class ContactSweeps<float, 3>;
template class ContactSweeps<double, 2>;
template class ContactSweeps<double, 3>;

}  // namespace continuo
