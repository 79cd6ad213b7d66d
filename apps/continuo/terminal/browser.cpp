// apps/continuo/terminal/browser.cpp
// Opens an address by xdg-open.
#include <apps/continuo/terminal/browser.hpp>
#include <apps/continuo/terminal/program.hpp>

namespace continuo::app {

void open_browser(const std::string& url) {
  // By a shell that ends at once: the browser is nobody's child, and is not waited for.
  run_program({"sh", "-c", "command -v xdg-open >/dev/null && (xdg-open \"$1\" &)", "view", url});
}

}  // namespace continuo::app
