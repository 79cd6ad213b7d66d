// apps/continuo/terminal/interrupt.hpp
#pragma once
#include <atomic>

namespace continuo::app {

/// True from the first Ctrl-C or SIGTERM on, so that the run can stop and keep what it has. One half a second later
/// ends the process. The handler is installed at the first call.
const std::atomic<bool>& interrupt_flag();

}  // namespace continuo::app
