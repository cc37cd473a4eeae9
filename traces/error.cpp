#include "traces/error.hpp"

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

}  // namespace vestige
