#include "analysis/plot/film/webp_animation.hpp"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cstdint>

#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

/// 0 … 100.
constexpr float kQuality = 75;

[[noreturn]] void fail(const char* cause) {
  throw Error("WebP", cause, "choose a smaller --width or a shorter time");
}

[[noreturn]] void fail_for_version() {
  throw Error("WebP", "another version of libwebp is installed", "install libwebp7 and libwebpmux3 of Debian 12");
}

/// Frees a picture's pixels.
struct Pixels {
  Pixels() {
    if (WebPPictureInit(&picture) == 0) fail_for_version();
  }
  ~Pixels() { WebPPictureFree(&picture); }
  Pixels(const Pixels&) = delete;
  Pixels& operator=(const Pixels&) = delete;

  WebPPicture picture;
};

struct Bytes {
  Bytes() { WebPDataInit(&data); }
  ~Bytes() { WebPDataClear(&data); }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;

  WebPData data;
};

}  // namespace

struct WebpAnimation::Parts {
  std::unique_ptr<WebPAnimEncoder, decltype(&WebPAnimEncoderDelete)> encoder{nullptr, &WebPAnimEncoderDelete};
  WebPConfig config;
};

WebpAnimation::WebpAnimation(std::size_t width, std::size_t height) : parts_(std::make_unique<Parts>()) {
  WebPAnimEncoderOptions options;
  if (WebPAnimEncoderOptionsInit(&options) == 0 || WebPConfigInit(&parts_->config) == 0) fail_for_version();
  options.allow_mixed = 1;
  // Every picture is whole. If only what has changed is encoded, slow changes, as of shadows, are left out block by
  // block.
  options.kmin = 0;
  options.kmax = 1;
  parts_->config.quality = kQuality;
  parts_->config.use_sharp_yuv = 1;  // otherwise colours run over the edges of small things
  parts_->encoder.reset(WebPAnimEncoderNew(static_cast<int>(width), static_cast<int>(height), &options));
  if (parts_->encoder == nullptr) fail("libwebp cannot get enough memory");
}

WebpAnimation::~WebpAnimation() = default;

void WebpAnimation::add(const Raster& picture, int time_ms) {
  Pixels pixels;
  pixels.picture.use_argb = 1;
  pixels.picture.width = static_cast<int>(picture.width());
  pixels.picture.height = static_cast<int>(picture.height());
  if (WebPPictureAlloc(&pixels.picture) == 0) fail("libwebp cannot get enough memory");
  for (std::size_t row = 0; row < picture.height(); ++row) {
    std::uint32_t* out = pixels.picture.argb + static_cast<std::ptrdiff_t>(row) * pixels.picture.argb_stride;
    for (std::size_t column = 0; column < picture.width(); ++column) {
      const Colour colour = picture.at(column, row);
      *out++ = 0xFF000000U | std::uint32_t{colour.red} << 16U | std::uint32_t{colour.green} << 8U | colour.blue;
    }
  }
  if (WebPAnimEncoderAdd(parts_->encoder.get(), &pixels.picture, time_ms, &parts_->config) == 0)
    fail(WebPAnimEncoderGetError(parts_->encoder.get()));
}

std::string WebpAnimation::finish(int end_ms) {
  Bytes file;
  if (WebPAnimEncoderAdd(parts_->encoder.get(), nullptr, end_ms, nullptr) == 0 ||
      WebPAnimEncoderAssemble(parts_->encoder.get(), &file.data) == 0)
    fail(WebPAnimEncoderGetError(parts_->encoder.get()));
  return {reinterpret_cast<const char*>(file.data.bytes), file.data.size};
}

}  // namespace vestige::plot
