#include "analysis/plot/data/texture_contacts.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfTestFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

constexpr std::string_view kRemedy = "name a file that 'vestige replay --textures FILE.exr' wrote";
constexpr const char* kPlane = "actuator";
/// More than any recording has; a damaged header may claim more than there is memory.
constexpr std::int64_t kMostColliders = std::int64_t{1} << 20;
constexpr std::int64_t kMostTexels = std::int64_t{1} << 32;
constexpr std::int64_t kTexelsAtOnce = std::int64_t{1} << 20;

void read_plane(const std::filesystem::path& path, std::size_t person, TextureContacts& result) {
  Imf::MultiPartInputFile parts(path.c_str());
  Imf::InputPart file(parts, static_cast<int>(person));
  const Imf::Channel* channel = file.header().channels().findChannel(kPlane);
  if (channel == nullptr) throw Error(path.string(), fmt::format("has no plane '{}'", kPlane), kRemedy);
  if (channel->xSampling != 1 || channel->ySampling != 1)
    throw Error(path.string(), fmt::format("the plane '{}' is subsampled", kPlane), kRemedy);
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width > kMostColliders || width * height > kMostTexels)
    throw Error(path.string(),
                fmt::format("has a header with {} colliders and {} frames, which are too many", width, height),
                kRemedy);
  result.colliders = static_cast<std::uint32_t>(width);
  result.frames = static_cast<std::uint32_t>(height);

  const std::int64_t rows_at_once = std::clamp<std::int64_t>(kTexelsAtOnce / width, 1, height);
  std::vector<float> texels(static_cast<std::size_t>(rows_at_once * width));
  for (std::int64_t first = 0; first < height; first += rows_at_once) {
    const std::int64_t count = std::min(rows_at_once, height - first);
    Imath::Box2i rows = window;
    rows.min.y = static_cast<int>(window.min.y + first);
    rows.max.y = static_cast<int>(window.min.y + first + count - 1);
    Imf::FrameBuffer buffer;
    buffer.insert(kPlane, Imf::Slice::Make(Imf::FLOAT, texels.data(), rows, sizeof(float),
                                           static_cast<std::size_t>(width) * sizeof(float)));
    file.setFrameBuffer(buffer);
    file.readPixels(rows.min.y, rows.max.y);
    for (std::int64_t texel = 0; texel < count * width; ++texel) {
      const float value = texels[static_cast<std::size_t>(texel)];
      if (value == std::numeric_limits<float>::infinity()) continue;
      const std::int64_t frame = first + texel / width;
      const std::int64_t collider = texel % width;
      if (!(value >= 0 && value <= std::numeric_limits<std::uint16_t>::max()) || value != std::floor(value))
        throw Error(fmt::format("{}, frame {}, collider {}", path.string(), frame, collider),
                    fmt::format("{} is not an actuator", value), kRemedy);
      result.contacts.push_back(
          {static_cast<std::uint32_t>(frame), static_cast<std::uint32_t>(collider), static_cast<std::uint16_t>(value)});
    }
  }
}

/// Calls `read`, and turns what OpenEXR throws into an `Error`.
template <typename Read>
auto read_exr(const std::filesystem::path& path, const Read& read) {
  if (!std::filesystem::exists(path)) throw Error(path.string(), "there is no such file", "check the name");
  if (std::filesystem::is_directory(path)) throw Error(path.string(), "is a folder", "name a file");
  if (!Imf::isOpenExrFile(path.c_str()))
    throw Error(path.string(), "is not an OpenEXR file, or cannot be read", kRemedy);
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(path.string(), fmt::format("is damaged or cut off ({})", error.what()), "write it again");
  }
}

}  // namespace

std::size_t people_in_textures(const std::filesystem::path& path) {
  return read_exr(path, [&] {
    const Imf::MultiPartInputFile file(path.c_str());
    return static_cast<std::size_t>(file.parts());
  });
}

TextureContacts read_texture_contacts(const std::filesystem::path& path, std::size_t person) {
  return read_exr(path, [&] {
    TextureContacts result;
    read_plane(path, person, result);
    return result;
  });
}

}  // namespace vestige::plot
