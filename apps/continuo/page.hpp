// apps/continuo/page.hpp
#pragma once
#include <string_view>

namespace continuo::app {

/// The page of the live view, compressed by gzip; empty in a build without it (CONTINUO_PAGE).
std::string_view built_in_page();

}  // namespace continuo::app
