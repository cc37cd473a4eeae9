#include "traces/hdf5/hdf5_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "traces/base/child_process.hpp"
#include "traces/base/error.hpp"
#include "traces/hdf5/hdf5_table.hpp"

namespace vestige {

bool has_hdf5_name(const std::filesystem::path& path) {
  return path.extension() == ".h5" || path.extension() == ".hdf5";
}

bool is_hdf5(const std::filesystem::path& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return false;
  std::array<char, 4> start = {};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  return std::string_view(start.data(), start.size()) == "\x89HDF";
}

Hdf5Handle open_hdf5(const std::filesystem::path& path, const char* remedy) {
  std::error_code failed;
  if (!std::filesystem::exists(path, failed)) throw Error(path.string(), "there is no such file", "check the name");
  Hdf5Handle file(hdf5().open_file(path.c_str(), kHdf5ReadOnly, H5P_DEFAULT), hdf5().close_file);
  if (file.id() < 0) throw Error(path.string(), "is not an HDF5 file, or is damaged", remedy);
  return file;
}

void try_hdf5(const std::filesystem::path& path, const std::function<void()>& read_all) {
  std::error_code unknown;
  const std::uint64_t bytes = std::filesystem::file_size(path, unknown);
  constexpr std::uint64_t kSlowestBytesPerSecond = 1'000'000;
  const std::uint64_t most_s = 5 + (unknown ? 0 : bytes / kSlowestBytesPerSecond);
  const int signal = signal_that_ends(read_all, most_s);
  const bool interrupted = signal == SIGINT || signal == SIGTERM || signal == SIGHUP;
  if (interrupted) throw Error(path.string(), "reading it was stopped", "");
  if (signal != 0)
    throw Error(path.string(),
                fmt::format("is damaged: the HDF5 library {} on it (signal {})",
                            signal == SIGXCPU ? "does not finish" : "crashes", signal),
                kHdf5DamagedRemedy);
}

namespace {

herr_t note_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

std::vector<std::string> visit_names(const std::filesystem::path& path) {
  const Hdf5Handle file = open_hdf5(path, kHdf5DamagedRemedy);
  std::vector<std::string> names;
  hdf5_check(hdf5().visit_links(file.id(), H5_INDEX_NAME, H5_ITER_INC, note_name, &names), path, "read the names");
  return names;
}

}  // namespace

std::vector<std::string> hdf5_names(const std::filesystem::path& path) {
  static_cast<void>(hdf5());
  try_hdf5(path, [&] { visit_names(path); });
  return visit_names(path);
}

std::vector<std::string> read_hdf5_texts(const std::filesystem::path& path, const std::string& what,
                                         const Hdf5TextShape& shape, const std::function<herr_t(void*)>& read) {
  const auto fail = [&](std::string_view cause, const char* remedy = kHdf5Remedy) {
    throw Error(path.string(), fmt::format("its {} {}", what, cause), remedy);
  };
  const Hdf5Library& h5 = hdf5();
  if (h5.class_of(shape.type) != H5T_STRING) fail("is not a text");
  const hssize_t count = h5.element_count(shape.space);
  const std::size_t size = h5.size_of(shape.type);
  constexpr hsize_t kMostTexts = 1000000;
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  if (count < 0 || static_cast<hsize_t>(count) > kMostTexts || size > kMostBytes ||
      static_cast<std::size_t>(count) * size > kMostBytes)
    fail("is too large");
  std::vector<std::string> texts(static_cast<std::size_t>(count));
  if (h5.is_variable_text(shape.type) > 0) {
    std::vector<char*> found(texts.size(), nullptr);
    if (read(static_cast<void*>(found.data())) < 0) fail("cannot be read", kHdf5DamagedRemedy);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      if (found[i] != nullptr) texts[i] = found[i];
      h5.free_memory(found[i]);
    }
    return texts;
  }
  std::string found(texts.size() * size, '\0');
  if (read(static_cast<void*>(found.data())) < 0) fail("cannot be read", kHdf5DamagedRemedy);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string_view text = std::string_view(found).substr(i * size, size);
    texts[i] = text.substr(0, text.find('\0'));  // the rest of a short text is padding
  }
  return texts;
}

std::optional<std::string> read_hdf5_attribute(hid_t file, const std::filesystem::path& path, const char* group,
                                               const std::string& key) {
  const Hdf5Library& h5 = hdf5();
  if (h5.attribute_exists(file, group, key.c_str(), H5P_DEFAULT) <= 0) return {};
  const std::string what = fmt::format("attribute '{}'", key);
  const Hdf5Handle attribute(h5.open_attribute(file, group, key.c_str(), H5P_DEFAULT, H5P_DEFAULT), h5.close_attribute);
  const Hdf5Handle type(h5.attribute_type(attribute.id()), h5.close_type);
  const Hdf5Handle space(h5.attribute_space(attribute.id()), h5.close_space);
  if (h5.element_count(space.id()) != 1)
    throw Error(path.string(), fmt::format("its {} is not one text", what), kHdf5Remedy);
  return read_hdf5_texts(path, what, {type.id(), space.id()},
                         [&](void* out) { return h5.read_attribute(attribute.id(), type.id(), out); })
      .front();
}

}  // namespace vestige
