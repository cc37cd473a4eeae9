#include "traces/base/error.hpp"

#include <cstdio>

namespace vestige {

namespace {

constexpr std::string_view kBeforeRemedy = "\n  ";

std::string compose(std::string_view where, std::string_view cause, std::string_view remedy) {
  std::string text;
  text.append(where).append(": ").append(cause);
  if (!remedy.empty()) text.append(kBeforeRemedy).append(remedy);
  return printable(text);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n') || byte == 0x7F) {
      constexpr std::string_view kDigits = "0123456789abcdef";
      safe.append("\\x").append(1, kDigits[byte / 16U]).append(1, kDigits[byte % 16U]);
    } else {
      safe += c;
    }
  }
  return safe;
}

Error::Error(std::string_view where, std::string_view cause, std::string_view remedy)
    : std::runtime_error(compose(where, cause, remedy)) {}

std::string_view Error::fault() const {
  const std::string_view text = what();
  return text.substr(0, text.find(kBeforeRemedy));
}

std::string_view Error::remedy() const {
  const std::string_view text = what();
  const std::size_t end = text.find(kBeforeRemedy);
  return end == std::string_view::npos ? "" : text.substr(end + kBeforeRemedy.size());
}

void print_message(const std::string& text) {
  static_cast<void>(std::fputs(text.c_str(), stderr));
}

}  // namespace vestige
