#include "number_text.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace kadans {

std::string printed(const char* pattern, ...) {
  char text[512];
  std::va_list values;
  va_start(values, pattern);
  const int length = std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  return {text, static_cast<std::size_t>(std::clamp(length, 0, static_cast<int>(sizeof text) - 1))};
}

}  // namespace kadans
