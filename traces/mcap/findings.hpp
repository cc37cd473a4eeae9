#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vestige::mcap {

/// Counts all faults in a file and keeps the first kMostKept of them, so that memory stays bounded for a file full of
/// faults. `Finding` has an `offset` in the file.
template <typename Finding>
class Findings {
 public:
  static constexpr std::size_t kMostKept = 1000;

  void add(Finding finding) {
    ++count_;
    if (kept_.size() < kMostKept) kept_.push_back(std::move(finding));
  }
  void add(const Findings& others) {
    for (const Finding& finding : others.kept_) add(finding);
    count_ += others.count_ - others.kept_.size();
  }
  void sort_by_offset() {
    std::stable_sort(kept_.begin(), kept_.end(), [](const auto& a, const auto& b) { return a.offset < b.offset; });
  }

  std::uint64_t count() const { return count_; }
  bool empty() const { return count_ == 0; }
  const std::vector<Finding>& kept() const { return kept_; }

 private:
  std::uint64_t count_ = 0;
  std::vector<Finding> kept_;
};

}  // namespace vestige::mcap
