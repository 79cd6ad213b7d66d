// apps/continuo/page.cpp
// The compressed page of the live view, included in the command by the assembler.
#include <apps/continuo/page.hpp>

#ifdef CONTINUO_PAGE_FILE
asm(".section .rodata\n"
    ".global continuo_page_begin\n"
    ".global continuo_page_end\n"
    "continuo_page_begin:\n"
    ".incbin \"" CONTINUO_PAGE_FILE
    "\"\n"
    "continuo_page_end:\n"
    ".byte 0\n"
    ".text\n");
extern "C" {
extern const char continuo_page_begin[], continuo_page_end[];
}
#endif

namespace continuo::app {

std::string_view built_in_page() {
#ifdef CONTINUO_PAGE_FILE
  return {continuo_page_begin, static_cast<std::size_t>(continuo_page_end - continuo_page_begin)};
#else
  return {};
#endif
}

}  // namespace continuo::app
