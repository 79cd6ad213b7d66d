// continuo_least_squares.so: the only part of the command that needs Ceres.
#include <continuo/studies/least_squares.hpp>

extern "C" {
extern decltype(&continuo::studies::least_squares) const continuo_module;
decltype(&continuo::studies::least_squares) const continuo_module = &continuo::studies::least_squares;
}
