#include "traces/mannequin/surface.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "traces/mannequin/shape.hpp"

namespace vestige::mannequin {

namespace {

namespace simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr glm::dvec3 kLow_m(0, -0.02, -0.20);
constexpr glm::dvec3 kHigh_m(0.86, 1.78, 0.24);

/// Returns the distance at each grid point. Blocks that the surface cannot reach get one value.
vtkNew<vtkImageData> sample(double spacing_m) {
  constexpr int kBlock = 8;
  const glm::ivec3 size = glm::ivec3((kHigh_m - kLow_m) / spacing_m) + 1;
  vtkNew<vtkImageData> image;
  image->SetDimensions(size.x, size.y, size.z);
  image->SetSpacing(spacing_m, spacing_m, spacing_m);
  image->SetOrigin(kLow_m.x, kLow_m.y, kLow_m.z);
  vtkNew<vtkFloatArray> values;
  values->SetNumberOfTuples(image->GetNumberOfPoints());
  const auto point = [&](int x, int y, int z) { return kLow_m + spacing_m * glm::dvec3(x, y, z); };
  for (int z0 = 0; z0 < size.z; z0 += kBlock)
    for (int y0 = 0; y0 < size.y; y0 += kBlock)
      for (int x0 = 0; x0 < size.x; x0 += kBlock) {
        const double middle = signed_distance(point(x0 + kBlock / 2, y0 + kBlock / 2, z0 + kBlock / 2));
        const bool far = std::abs(middle) > 2 * kBlock * spacing_m;
        for (int z = z0; z < std::min(z0 + kBlock, size.z); ++z)
          for (int y = y0; y < std::min(y0 + kBlock, size.y); ++y)
            for (int x = x0; x < std::min(x0 + kBlock, size.x); ++x)
              values->SetValue((vtkIdType{z} * size.y + y) * size.x + x,
                               static_cast<float>(far ? middle : signed_distance(point(x, y, z))));
      }
  image->GetPointData()->SetScalars(values);
  return image;
}

Mesh contour(vtkImageData* image) {
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(image);
  edges->SetValue(0, 0);
  edges->ComputeNormalsOff();
  edges->Update();
  vtkPolyData* surface = edges->GetOutput();
  Mesh mesh;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
    const double* p = surface->GetPoint(i);
    mesh.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
  }
  vtkCellArray* triangles = surface->GetPolys();
  vtkIdType corners = 0;
  const vtkIdType* corner = nullptr;
  for (triangles->InitTraversal(); triangles->GetNextCell(corners, corner);)
    mesh.add_face(Mesh::Vertex_index(static_cast<std::uint32_t>(corner[0])),
                  Mesh::Vertex_index(static_cast<std::uint32_t>(corner[2])),
                  Mesh::Vertex_index(static_cast<std::uint32_t>(corner[1])));
  return mesh;
}

/// Lindstrom and Turk's cost, plus a little for length, so that limbs do not become bundles of slivers, which bend
/// badly. The cost is raised at face, hands and toes, where small shapes are more visible than their size suggests.
struct Cost {
  static constexpr double kEvenness = 1e-4;

  template <typename Profile, typename Placement>
  auto operator()(const Profile& profile, const Placement& placement) const {
    auto cost = simplification::LindstromTurk_cost<Mesh>()(profile, placement);
    const double squared_length = CGAL::squared_distance(profile.p0(), profile.p1());
    if (cost) *cost = *cost * detail_at(profile.p0()) + kEvenness * squared_length * squared_length * squared_length;
    return cost;
  }

  static double detail_at(const Kernel::Point_3& p) {
    if (p.y() > 1.52) return p.z() > 0.06 ? 100 : 8;
    if (p.x() > 0.58) return 12;
    if (p.y() < 0.05 && p.z() > 0.08) return 4;
    return 1;
  }
};

void simplify(Mesh& mesh, std::size_t triangle_count) {
  // Euler: a half body is a disk. Each collapse removes 3 edges and 2 triangles; border edges come on top.
  while (mesh.number_of_faces() > triangle_count) {
    const std::size_t edges = mesh.number_of_edges() - (mesh.number_of_faces() - triangle_count) * 3 / 2;
    const std::size_t before = mesh.number_of_faces();
    simplification::edge_collapse(
        mesh, simplification::Count_stop_predicate<Mesh>(edges),
        CGAL::parameters::get_cost(Cost()).get_placement(simplification::LindstromTurk_placement<Mesh>()));
    mesh.collect_garbage();
    if (mesh.number_of_faces() == before) break;
  }
}

}  // namespace

Surface make_surface(double spacing_m, std::size_t triangle_count) {
  Mesh half = contour(sample(spacing_m));
  simplify(half, triangle_count / 2);
  Surface surface;
  for (const auto vertex : half.vertices()) {
    const auto& p = half.point(vertex);
    const bool middle = half.is_border(vertex);
    surface.positions_m.emplace_back(middle ? 0 : p.x(), p.y(), p.z());
    surface.mirror.push_back(vertex.idx());
  }
  for (const auto vertex : half.vertices()) {
    if (half.is_border(vertex)) continue;
    const glm::dvec3 p = surface.positions_m[vertex.idx()];
    surface.mirror[vertex.idx()] = static_cast<std::uint32_t>(surface.positions_m.size());
    surface.positions_m.emplace_back(-p.x, p.y, p.z);
    surface.mirror.push_back(vertex.idx());
  }
  for (const auto face : half.faces()) {
    glm::uvec3 triangle;
    int corner = 0;
    for (const auto vertex : vertices_around_face(half.halfedge(face), half)) triangle[corner++] = vertex.idx();
    surface.triangles.push_back(triangle);
  }
  for (std::size_t i = 0, n = surface.triangles.size(); i < n; ++i) {
    const glm::uvec3 t = surface.triangles[i];
    surface.triangles.emplace_back(surface.mirror[t.x], surface.mirror[t.z], surface.mirror[t.y]);
  }
  return surface;
}

}  // namespace vestige::mannequin
