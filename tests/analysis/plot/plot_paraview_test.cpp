// Traces as time series for ParaView: runs vestige-plot as a user does, and reads what it wrote with VTK's own reader,
// which is ParaView's.

#include <gmock/gmock.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/analysis/plot/plot_fixture.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/scene/reference_skinning.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

vtkNew<vtkPolyData> read_vtp(const std::filesystem::path& file) {
  vtkNew<vtkXMLPolyDataReader> reader;
  EXPECT_NE(reader->CanReadFile(file.c_str()), 0) << file;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkNew<vtkPolyData> data;
  data->ShallowCopy(reader->GetOutput());
  return data;
}

struct Listed {
  double time_s = 0;
  int part = 0;
  std::filesystem::path file;
};

std::vector<Listed> read_pvd(const std::filesystem::path& list) {
  test::words_of(list);  // it is XML
  const std::string text = read_text_file(list);
  const std::regex entry("<DataSet timestep=\"([^\"]*)\" part=\"([0-9])\" name=\"[a-z]*\" file=\"([^\"]*)\"/>");
  std::vector<Listed> found;
  for (std::sregex_iterator it(text.begin(), text.end(), entry); it != std::sregex_iterator(); ++it)
    found.push_back({std::stod((*it)[1]), std::stoi((*it)[2]), list.parent_path() / (*it)[3].str()});
  return found;
}

class ParaviewTest : public test::PlotTest {
 protected:
  void record(const std::string& flags) const {
    const test::Outcome outcome = test::run("vestige record --map builtin -q -o man.mcap " + flags, folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  }
  std::size_t contacts_of_replay() const {
    const test::Outcome outcome = test::run("vestige replay man.mcap --detector cpu --json -", folder_.path());
    return nlohmann::json::parse(outcome.standard_output).at("contacts");
  }
};

TEST_F(ParaviewTest, EveryStepHasTheSkinWithRegionsAndAmplitudesTheCollidersAndAllContacts) {
  record("--colliders swarm --rate 250 --duration 0.5");
  const test::Outcome outcome = run("paraview man.mcap");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::vector<Listed> listed = read_pvd(folder_ / "man.pvd");
  ASSERT_GT(listed.size(), 3U * 25);
  ASSERT_LT(listed.size(), 3U * 35);  // 60 Hz of half a second

  TraceReader trace(folder_ / "man.mcap");
  const Avatar avatar = parse_avatar_glb(trace.people().front().avatar_glb, "avatar");
  TraceFrame frame;
  std::vector<glm::dvec3> skin_m;
  std::size_t contacts = 0;
  std::size_t counted_on_skin = 0;
  bool something_vibrates = false;
  for (std::size_t i = 0; i < listed.size(); i += 3) {
    if (i > 0) {
      EXPECT_GT(listed[i].time_s, listed[i - 3].time_s);
    }
    do {
      ASSERT_TRUE(trace.next(frame));
    } while (std::abs(static_cast<double>(frame.time_ns) * 1e-9 - listed[i].time_s) > 1e-7);
    const auto skin = read_vtp(listed[i].file);
    ASSERT_EQ(static_cast<std::size_t>(skin->GetNumberOfPoints()), avatar.position_bind.size());
    ASSERT_EQ(static_cast<std::size_t>(skin->GetNumberOfPolys()), avatar.triangles.size());
    skin_reference(avatar, frame.poses.front(), glm::dvec3(0), skin_m);
    EXPECT_NEAR(skin->GetPoint(77)[1], skin_m[77].y, 1e-9);
    EXPECT_EQ(skin->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), listed[i].time_s);
    vtkDataArray& actuator = *skin->GetCellData()->GetArray("actuator");
    vtkDataArray& amplitude = *skin->GetCellData()->GetArray("amplitude");
    vtkDataArray& on_skin = *skin->GetCellData()->GetArray("contacts");
    EXPECT_EQ(actuator.GetRange()[1], 6);
    for (vtkIdType cell = 0; cell < amplitude.GetNumberOfTuples(); ++cell) {
      counted_on_skin += static_cast<std::size_t>(on_skin.GetTuple1(cell));
      if (amplitude.GetTuple1(cell) == 0) continue;
      something_vibrates = true;
      EXPECT_GT(actuator.GetTuple1(cell), 0);
    }
    EXPECT_EQ(read_vtp(listed[i + 1].file)->GetNumberOfVerts(), static_cast<vtkIdType>(frame.colliders.size()));
    contacts += static_cast<std::size_t>(read_vtp(listed[i + 2].file)->GetNumberOfVerts());
  }
  EXPECT_FALSE(trace.next(frame)) << "the last frame is the last step";
  EXPECT_GT(contacts, 0U);
  EXPECT_EQ(contacts, contacts_of_replay());
  EXPECT_EQ(counted_on_skin, contacts);
  EXPECT_TRUE(something_vibrates);
}

TEST_F(ParaviewTest, NamesTheActuatorsAndGivesTheMapsTextureCoordinates) {
  record("--colliders slide --rate 100 --duration 0.1");
  ASSERT_EQ(run("paraview man.mcap --every 5 --law phantom -o out/of/here.pvd").exit_code, 0);
  const std::vector<Listed> listed = read_pvd(folder_ / "out/of/here.pvd");
  ASSERT_GE(listed.size(), 6U);
  const auto skin = read_vtp(listed[0].file);
  const auto* names = vtkStringArray::SafeDownCast(skin->GetFieldData()->GetAbstractArray("actuator_name"));
  ASSERT_NE(names, nullptr);
  EXPECT_EQ(const_cast<vtkStringArray*>(names)->GetValue(0), "upper torso, right");
  EXPECT_NE(skin->GetPointData()->GetTCoords(), nullptr);
}

TEST_F(ParaviewTest, SaysOfOneStepThatItIsOne) {
  record("--rate 10 --duration 0.1");
  EXPECT_THAT(run("paraview man.mcap").standard_error, HasSubstr("man.pvd: 1 time step from 1 frame, 0 contacts"));
}

TEST_F(ParaviewTest, LeavesWhatIsThereAloneUnlessForced) {
  record("--colliders still --rate 20 --duration 0.5");
  ASSERT_EQ(run("paraview man.mcap --every 1").exit_code, 0);
  const std::string before = read_text_file(folder_ / "man.pvd");
  test::write_text(folder_ / "man" / "notes.txt", "mine");
  const test::Outcome refused = run("paraview man.mcap --every 5");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.standard_error, AllOf(HasSubstr("man: already exists"), HasSubstr("--force")));
  EXPECT_EQ(read_text_file(folder_ / "man.pvd"), before);
  ASSERT_EQ(run("paraview man.mcap --every 5 --force").exit_code, 0);
  const std::size_t files = 1 + read_pvd(folder_ / "man.pvd").size();
  const std::filesystem::directory_iterator folder(folder_ / "man");
  EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(folder), end(folder))), files)
      << "steps of the longer series before are gone, and what is not ours stays";
  EXPECT_EQ(read_text_file(folder_ / "man" / "notes.txt"), "mine");
}

TEST_F(ParaviewTest, AnInterruptedSeriesEndsWithWholeSteps) {
  record("--colliders swarm --rate 1000 --duration 4");
  const test::Outcome outcome = test::run(
      "vestige-plot paraview man.mcap --every 1 & pid=$!\n"
      "while [ ! -e .man.$pid/contacts_000005.vtp ] && kill -0 $pid; do sleep 0.01; done\n"
      "kill -INT $pid; wait $pid",
      folder_.path());
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("stopped after"));
  const std::vector<Listed> listed = read_pvd(folder_ / "man.pvd");
  ASSERT_GT(listed.size(), 3U * 5);
  for (const Listed& one : listed) EXPECT_TRUE(std::filesystem::exists(one.file)) << one.file;
  read_vtp(listed[listed.size() - 3].file);
  EXPECT_EQ(file_count(), 3U) << "trace, list and folder";
}

TEST_F(ParaviewTest, SaysWhatItCannotDo) {
  EXPECT_EQ(run("paraview nowhere.mcap").exit_code, 1);
  test::write_text(folder_ / "text.mcap", "no trace");
  EXPECT_THAT(run("paraview text.mcap").standard_error, HasSubstr("text.mcap"));
  EXPECT_EQ(file_count(), 1U) << "nothing is left of the attempt";
  record("--colliders still --rate 20 --duration 0.2");
  EXPECT_EQ(run("paraview man.mcap --every 2 --rate 10").exit_code, 2);
  const test::Outcome law = run("paraview man.mcap --law loud");
  EXPECT_EQ(law.exit_code, 2);
  EXPECT_THAT(law.standard_error, HasSubstr("--law"));
  EXPECT_EQ(file_count(), 2U);
}

}  // namespace
}  // namespace vestige
