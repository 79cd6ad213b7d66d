// continuo/simulation/drive/integrate_symplectic.cpp
// Instantiates the integration of models for the symplectic compositions.
#include <continuo/methods/symplectic/kahan_li8.hpp>
#include <continuo/methods/symplectic/mclachlan_atela4.hpp>
#include <continuo/methods/symplectic/yoshida6.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<KahanLi8>();
template ModelMethod model_method<McLachlanAtela4>();
template ModelMethod model_method<Yoshida6>();

}  // namespace continuo::model
