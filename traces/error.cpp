#include "traces/error.hpp"

#include <cstdio>

namespace vestige {

namespace {
std::string compose(std::string_view where, std::string_view cause, std::string_view remedy) {
  std::string text;
  text.append(where).append(": ").append(cause);
  if (!remedy.empty()) text.append("\n  ").append(remedy);
  return text;
}
}  // namespace

Error::Error(std::string_view where, std::string_view cause, std::string_view remedy)
    : std::runtime_error(compose(where, cause, remedy)) {}

void print_message(const std::string& text) {
  static_cast<void>(std::fputs(text.c_str(), stderr));
}

}  // namespace vestige
