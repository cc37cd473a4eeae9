#include "detector/detectors/embree_detector.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "detector/broad/skin_motion.hpp"
#include "detector/detectors/contact_description.hpp"
#include "traces/base/error.hpp"
#include "traces/base/shared_library.hpp"

namespace vestige {

namespace {

/// Embree's functions, with the types of its header, found at run time.
struct EmbreeLibrary {
  decltype(&rtcNewDevice) new_device;
  decltype(&rtcReleaseDevice) release_device;
  decltype(&rtcGetDeviceError) device_error;
  decltype(&rtcNewScene) new_scene;
  decltype(&rtcReleaseScene) release_scene;
  decltype(&rtcSetSceneFlags) set_scene_flags;
  decltype(&rtcSetSceneBuildQuality) set_scene_build_quality;
  decltype(&rtcCommitScene) commit_scene;
  decltype(&rtcNewGeometry) new_geometry;
  decltype(&rtcReleaseGeometry) release_geometry;
  decltype(&rtcSetGeometryBuildQuality) set_geometry_build_quality;
  decltype(&rtcSetNewGeometryBuffer) new_buffer;
  decltype(&rtcUpdateGeometryBuffer) update_buffer;
  decltype(&rtcSetGeometryUserData) set_user_data;
  decltype(&rtcSetGeometryIntersectFilterFunction) set_filter;
  decltype(&rtcCommitGeometry) commit_geometry;
  decltype(&rtcAttachGeometry) attach_geometry;
  decltype(&rtcIntersect1) intersect;

  EmbreeLibrary() {
    const SharedLibrary library = open();
    library.find("rtcNewDevice", new_device);
    library.find("rtcReleaseDevice", release_device);
    library.find("rtcGetDeviceError", device_error);
    library.find("rtcNewScene", new_scene);
    library.find("rtcReleaseScene", release_scene);
    library.find("rtcSetSceneFlags", set_scene_flags);
    library.find("rtcSetSceneBuildQuality", set_scene_build_quality);
    library.find("rtcCommitScene", commit_scene);
    library.find("rtcNewGeometry", new_geometry);
    library.find("rtcReleaseGeometry", release_geometry);
    library.find("rtcSetGeometryBuildQuality", set_geometry_build_quality);
    library.find("rtcSetNewGeometryBuffer", new_buffer);
    library.find("rtcUpdateGeometryBuffer", update_buffer);
    library.find("rtcSetGeometryUserData", set_user_data);
    library.find("rtcSetGeometryIntersectFilterFunction", set_filter);
    library.find("rtcCommitGeometry", commit_geometry);
    library.find("rtcAttachGeometry", attach_geometry);
    library.find("rtcIntersect1", intersect);
  }

 private:
  static SharedLibrary open() {
    constexpr const char* kName = "libembree3.so.3";
    try {
      return SharedLibrary(kName);
    } catch (const Error& error) {
      throw Error("--detector embree", fmt::format("Embree 3 cannot be opened: {}", error.what()),
                  "install the package libembree3-3, or choose --detector cpu");
    }
  }
};

/// Opened once for the whole program: a library is never closed.
const EmbreeLibrary& embree() {
  static const EmbreeLibrary library;
  return library;
}

/// An owner of an Embree object that is reference-counted; releases it at the end.
template <typename Object>
using Handle = std::unique_ptr<std::remove_pointer_t<Object>, void (*)(Object)>;

class EmbreeDetector final : public Detector {
 public:
  EmbreeDetector(EmbreeMode mode, const Avatar& avatar, const ActuatorMap& map, const DetectorOptions& options)
      : mode_(mode),
        avatar_(avatar),
        map_(map),
        device_(embree().new_device("threads=1"), embree().release_device),
        scene_(embree().new_scene(device_.get()), embree().release_scene),
        geometry_(embree().new_geometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE), embree().release_geometry) {
    check("making a scene");
    const int robust = mode == EmbreeMode::kRobust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
    // Measured fastest (docs/design/detectors.md): a compact tree refers to the vertices and copies none, so that its
    // refit has less to write.
    embree().set_scene_flags(scene_.get(),
                             static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_COMPACT | robust));
    embree().set_scene_build_quality(scene_.get(), RTC_BUILD_QUALITY_LOW);
    embree().set_geometry_build_quality(geometry_.get(), RTC_BUILD_QUALITY_REFIT);
    vertices_ = new_buffer<glm::vec3>(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, avatar.position_bind.size());
    auto* indices = new_buffer<glm::uvec3>(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, avatar.triangles.size());
    std::ranges::copy(avatar.triangles, indices);
    std::ranges::copy(avatar.position_bind, vertices_);
    embree().set_user_data(geometry_.get(), this);
    if (options.surface == Surface::kMapped) embree().set_filter(geometry_.get(), &pass_through_unmapped);
    embree().commit_geometry(geometry_.get());
    embree().attach_geometry(scene_.get(), geometry_.get());
    embree().commit_scene(scene_.get());
    check("building the tree");
  }

  const char* name() const override { return mode_ == EmbreeMode::kRobust ? "embree" : "embree_default"; }

  DetectorWork detect(const DetectorFrame& frame, ContactRow& row) override {
    row.clear(frame.columns);
    if (frame.segments.empty()) return {};
    enter(Stage::kSkinning);
    skin_vertices(avatar_, frame.palette, vertices());
    enter(Stage::kCandidates);
    embree().update_buffer(geometry_.get(), RTC_BUFFER_TYPE_VERTEX, 0);
    embree().commit_geometry(geometry_.get());
    embree().commit_scene(scene_.get());
    frame_ = &frame;
    for (const Segment& segment : frame.segments) row[segment.column] = first_contact(segment);
    check("detecting contacts");
    return {.pairs_tested = frame.segments.size() * avatar_.triangles.size(),
            .triangles_tested = avatar_.triangles.size()};
  }

  void skinned_vertices(const DetectorFrame& frame, std::vector<glm::vec3>& out) override {
    skin_vertices(avatar_, frame.palette, out);
  }

 private:
  template <typename Element>
  Element* new_buffer(RTCBufferType type, RTCFormat format, std::size_t count) {
    void* data = embree().new_buffer(geometry_.get(), type, 0, format, sizeof(Element), count);
    check("making a buffer");
    return static_cast<Element*>(data);
  }

  void check(const char* doing) const {
    const RTCError failure = embree().device_error(device_.get());
    if (failure == RTC_ERROR_NONE) return;
    throw Error("embree", fmt::format("error {} while {}", static_cast<int>(failure), doing),
                "choose --detector cpu, which finds the same contacts and more");
  }

  Contact first_contact(const Segment& segment) {
    enter(Stage::kTest);
    segment_ = &segment;
    const glm::vec3 direction = segment.end - segment.start;
    RTCRayHit query = {};
    query.ray.org_x = segment.start.x;
    query.ray.org_y = segment.start.y;
    query.ray.org_z = segment.start.z;
    query.ray.dir_x = direction.x;
    query.ray.dir_y = direction.y;
    query.ray.dir_z = direction.z;
    query.ray.tfar = 1;
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    embree().intersect(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    enter(Stage::kDecision);
    return describe(query.hit.primID, query.ray.tfar);
  }

  std::span<glm::vec3> vertices() const { return {vertices_, avatar_.position_bind.size()}; }

  Contact describe(std::uint32_t triangle, float t) const {
    const Corners corners = corners_of(avatar_, vertices(), triangle);
    const Way way = {glm::dvec3(segment_->start), glm::dvec3(segment_->end)};
    const double along =
        glm::dot(glm::cross(corners.b - corners.a, corners.c - corners.a), way.start - way.end);  // > 0: from the front
    const std::int8_t side = along > 0 ? 1 : (along < 0 ? -1 : 0);
    return describe_contact(avatar_, map_, {triangle, way, corners, {t + 0.0F, side}}, frame_->duration_s);
  }

  /// Embree calls this for each contact to ask whether it counts.
  static void pass_through_unmapped(const RTCFilterFunctionNArguments* arguments) {
    const auto* detector = static_cast<const EmbreeDetector*>(arguments->geometryUserPtr);
    for (unsigned i = 0; i < arguments->N; ++i) {
      if (arguments->valid[i] == 0) continue;
      const Contact contact = detector->describe(RTCHitN_primID(arguments->hit, arguments->N, i),
                                                 RTCRayN_tfar(arguments->ray, arguments->N, i));
      if (contact.actuator == 0) arguments->valid[i] = 0;
    }
  }

  EmbreeMode mode_;
  const Avatar& avatar_;
  const ActuatorMap& map_;
  Handle<RTCDevice> device_;
  Handle<RTCScene> scene_;
  Handle<RTCGeometry> geometry_;
  glm::vec3* vertices_ = nullptr;         ///< Embree's own buffer, one entry for each vertex
  const DetectorFrame* frame_ = nullptr;  ///< set while `detect` runs
  const Segment* segment_ = nullptr;
};

}  // namespace

void require_embree() {
  embree();
}

std::unique_ptr<Detector> make_embree_detector(EmbreeMode mode, const Avatar& avatar, const ActuatorMap& map,
                                               const DetectorOptions& options) {
  if (options.method != Method::kStatic)
    throw UsageError("--method", fmt::format("Embree has no method '{}'", name_of(options.method)),
                     "choose --detector cpu, or --method static");
  return std::make_unique<EmbreeDetector>(mode, avatar, map, options);
}

}  // namespace vestige
