// Machine code for the equations of a model:
//
//   loaded.model->native = std::make_shared<NativeCompiler>(NativeOptions{.use = NativeUse::always});
//   const Simulated simulated = simulate(*loaded.model);
//   loaded.model->native->report().compiled
//
// Without this line all is computed by tapes. The results are the same to the bit; docs/native.md says what it brings.
#pragma once
#include <continuo/symbolic/native/native_compiler.hpp>
