#include <stdexcept>

#include "detector/exact/truth.hpp"

namespace vestige::exact {

std::optional<FirstContact> static_contact(const Way&, const Corners&) {
  throw std::logic_error("not built yet");
}

}  // namespace vestige::exact
