#include "hooke/text_of.h"

#include <cstdarg>
#include <cstdio>

namespace hooke::app {

std::string text_of(const char* format, ...) {
  char text[1001];
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

}  // namespace hooke::app
