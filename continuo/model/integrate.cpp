// continuo/model/integrate.cpp
#include <utility>

#include <continuo/model/integrate.hpp>
#include <continuo/solve/with_method.hpp>

namespace continuo::model {

void integrate(std::string_view method, Integration integration, RunRecorder& recorder, Run& run) {
  with_method(method, [&](auto chosen) { integrate_by<decltype(chosen)>(std::move(integration), recorder, run); });
}

}  // namespace continuo::model
