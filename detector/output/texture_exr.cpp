#include "detector/output/texture_exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>

#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include "detector/actuators/pressure.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

struct ChannelFormat {
  const char* name;
  Plane plane;
  Imf::PixelType type;
  std::uint32_t (*bits)(const Contact&);
};

std::uint32_t float_bits(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

constexpr std::array<ChannelFormat, 14> kChannels = {{
    {"actuator", Plane::kActuator, Imf::FLOAT, [](const Contact& c) { return float_bits(c.actuator); }},
    {"t", Plane::kTime, Imf::FLOAT, [](const Contact& c) { return std::bit_cast<std::uint32_t>(c.t); }},
    {"triangle", Plane::kTriangle, Imf::UINT, [](const Contact& c) { return c.triangle; }},
    {"u", Plane::kBarycentric, Imf::FLOAT, [](const Contact& c) { return float_bits(c.barycentric.x); }},
    {"v", Plane::kBarycentric, Imf::FLOAT, [](const Contact& c) { return float_bits(c.barycentric.y); }},
    {"texture_u", Plane::kTextureCoordinate, Imf::FLOAT,
     [](const Contact& c) { return float_bits(c.texture_coordinate.x); }},
    {"texture_v", Plane::kTextureCoordinate, Imf::FLOAT,
     [](const Contact& c) { return float_bits(c.texture_coordinate.y); }},
    {"x", Plane::kPosition, Imf::FLOAT, [](const Contact& c) { return float_bits(c.position.x); }},
    {"y", Plane::kPosition, Imf::FLOAT, [](const Contact& c) { return float_bits(c.position.y); }},
    {"z", Plane::kPosition, Imf::FLOAT, [](const Contact& c) { return float_bits(c.position.z); }},
    {"speed", Plane::kSpeed, Imf::FLOAT, [](const Contact& c) { return float_bits(c.speed_m_per_s); }},
    {"side", Plane::kSide, Imf::FLOAT, [](const Contact& c) { return float_bits(c.side); }},
    {"pressure", Plane::kPressure, Imf::FLOAT, [](const Contact& c) { return float_bits(pressure_of(c)); }},
    {"depth", Plane::kDepth, Imf::FLOAT, [](const Contact& c) { return float_bits(c.depth_m); }},
}};

/// OpenEXR writes into memory, and `OutputFile` writes to the disk. So a full disk is reported in the same way
/// everywhere.
class MemoryStream final : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (place_ + size > content_.size()) content_.resize(place_ + size);
    std::memcpy(content_.data() + place_, bytes, size);
    place_ += size;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = place; }
  const std::string& content() const { return content_; }

 private:
  std::string content_;
  std::size_t place_ = 0;
};

}  // namespace

TextureExr::TextureExr(PlaneSet planes, std::size_t columns, std::map<std::string, std::string> attributes,
                       const std::vector<std::string>& people)
    : planes_(planes), columns_(columns), attributes_(std::move(attributes)) {
  for (const std::string& name : people) people_.push_back({.name = name});
}

void TextureExr::add(std::size_t person, const DetectorFrame& frame, const ContactRow& row) {
  PersonImage& image = people_[person];
  for (std::uint32_t column = 0; column < row.size(); ++column) {
    if (!row[column].hit()) continue;
    Contact contact = row[column];
    contact.position += frame.origin_m;
    image.texels.push_back({image.rows, column, contact});
  }
  ++image.rows;
}

void TextureExr::write(OutputFile& file) const {
  const std::uint32_t rows = people_.front().rows;  // as many as of everybody
  if (rows == 0 || columns_ == 0)
    throw Error(file.path().string(), "the trace has no frame or no collider, so there is no texture to write",
                "replay a trace with frames and colliders");
  Imf::Header header(static_cast<int>(columns_), static_cast<int>(rows));
  header.compression() = Imf::ZIPS_COMPRESSION;
  for (const auto& [name, value] : attributes_) header.insert(name, Imf::StringAttribute(value));
  for (const ChannelFormat& channel : kChannels)
    if (planes_.has(channel.plane)) header.channels().insert(channel.name, Imf::Channel(channel.type));
  MemoryStream stream;
  if (people_.size() == 1) {
    Imf::OutputFile image(stream, header);
    write_rows(people_.front(), image);
  } else {
    std::vector<Imf::Header> headers(people_.size(), header);
    for (std::size_t person = 0; person < people_.size(); ++person) {
      headers[person].setName(people_[person].name);
      headers[person].setType(Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile parts(stream, headers.data(), static_cast<int>(headers.size()));
    for (std::size_t person = 0; person < people_.size(); ++person) {
      Imf::OutputPart image(parts, static_cast<int>(person));
      write_rows(people_[person], image);
    }
  }
  file.write(stream.content());
}

template <typename Image>
void TextureExr::write_rows(const PersonImage& person, Image& image) const {
  std::vector<const ChannelFormat*> channels;
  for (const ChannelFormat& channel : kChannels)
    if (planes_.has(channel.plane)) channels.push_back(&channel);
  std::vector<std::uint32_t> line(channels.size() * columns_);
  Imf::FrameBuffer frame_buffer;
  for (std::size_t i = 0; i < channels.size(); ++i)
    // With a y stride of 0, every row is written from the same line.
    frame_buffer.insert(channels[i]->name, Imf::Slice(channels[i]->type, reinterpret_cast<char*>(&line[i * columns_]),
                                                      sizeof(std::uint32_t), 0));
  image.setFrameBuffer(frame_buffer);
  auto texel = person.texels.begin();
  for (std::uint32_t row = 0; row < person.rows; ++row) {
    for (std::size_t i = 0; i < channels.size(); ++i)
      std::fill_n(&line[i * columns_], columns_,
                  channels[i]->type == Imf::UINT ? kNoTriangle : float_bits(std::numeric_limits<double>::infinity()));
    for (; texel != person.texels.end() && texel->row == row; ++texel)
      for (std::size_t i = 0; i < channels.size(); ++i)
        line[i * columns_ + texel->column] = channels[i]->bits(texel->contact);
    image.writePixels(1);
  }
}

}  // namespace vestige
