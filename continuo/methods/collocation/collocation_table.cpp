// continuo/methods/collocation/collocation_table.cpp
// Instantiates the tables of collocation methods for the usual scalars.
#include <continuo/methods/collocation/collocation_table.hpp>

namespace continuo::collocation {

template const Table<float, Nodes::gauss, 2>& table();
template const Table<float, Nodes::radau, 3>& table();
template const Table<float, Nodes::radau, 5>& table();
template const Table<float, Nodes::radau, 7>& table();
template const Table<double, Nodes::gauss, 2>& table();
template const Table<double, Nodes::radau, 3>& table();
template const Table<double, Nodes::radau, 5>& table();
template const Table<double, Nodes::radau, 7>& table();
template const Table<long double, Nodes::gauss, 2>& table();
template const Table<long double, Nodes::radau, 3>& table();
template const Table<long double, Nodes::radau, 5>& table();
template const Table<long double, Nodes::radau, 7>& table();

}  // namespace continuo::collocation
