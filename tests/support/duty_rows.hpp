// What motors did: rows of a timeline, of a stream's log, or of what the simulated board measured at its pins.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace vestige::test {

using Levels = std::vector<int>;

/// A row of a timeline, of a log, or of what the board's pins showed.
struct Row {
  double time_s = 0;
  std::string state;
  Levels level;
};

/// Skips the columns that are neither the time, nor the state, nor levels.
inline std::vector<Row> read_rows(const std::filesystem::path& file, std::size_t level_column) {
  std::ifstream stream(file);
  std::vector<Row> rows;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    Row row;
    std::string cell;
    for (std::size_t column = 0; std::getline(cells, cell, ','); ++column) {
      if (column == 0) row.time_s = std::stod(cell);
      if (column == 1 && level_column > 1) row.state = cell;
      if (column >= level_column) row.level.push_back(std::stoi(cell));
    }
    rows.push_back(row);
  }
  return rows;
}

inline std::vector<Row> read_timeline(const std::filesystem::path& file) {
  return read_rows(file, 1);
}
inline std::vector<Row> read_log(const std::filesystem::path& file) {
  return read_rows(file, 3);
}

}  // namespace vestige::test
