// apps/continuo/terminal/interrupt.hpp
#pragma once
#include <atomic>
#include <string>

namespace continuo::app {

/// True from the first Ctrl-C or SIGTERM on, so that the run can stop and keep what it has. One half a second later
/// ends the process. The handler is installed at the first call.
const std::atomic<bool>& interrupt_flag();

/// What standard output gets from a Ctrl-C or SIGTERM that ends the process, before the first call of `interrupt_flag`
/// or by the second one; the exit code is then 130. Empty: nothing any more, as is from the beginning.
void answer_interrupt_with(const std::string& text);

}  // namespace continuo::app
