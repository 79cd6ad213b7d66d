// apps/continuo/terminal/browser.hpp
#pragma once
#include <string>

namespace continuo::app {

/// Asks the desktop to open the address, if there is one, and does not wait for it. The address is printed anyway.
void open_browser(const std::string& url);

}  // namespace continuo::app
