#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// How the shaders of one stage compute with `precise` floats, as far as a probe of a few operands shows. The probe
/// proves nothing: other operands may be treated otherwise. But a driver that rounds otherwise is likely to show it.
struct StageArithmetic {
  std::string stage;     ///< "vertex", "geometry", "compute"
  std::string rounding;  ///< of + - *: "nearest even", "toward zero", "up", "down", or "other"
  /// The first sum or product that is not rounded to nearest even, as text. Empty if there is none.
  std::string misrounded;
  bool keeps_denormal_operands = false;
  bool keeps_denormal_results = false;
  bool contracts = false;         ///< a * b + c is rounded only once
  double division_error_ulp = 0;  ///< largest error that was seen; 0.5 at most if divisions are rounded to nearest

  friend bool operator==(const StageArithmetic&, const StageArithmetic&) = default;
};

enum class ProbeOperation : std::uint32_t { kAdd, kSubtract, kMultiply, kDivide, kMultiplyAdd };

/// One question to a shader: operands, and what to compute with them. `c` is for kMultiplyAdd only.
struct ProbeQuestion {
  float a = 0;
  float b = 0;
  float c = 0;
  ProbeOperation operation = ProbeOperation::kAdd;
};

/// Returns the questions that `judge` needs the answers to.
std::span<const ProbeQuestion> probe_questions();

/// Returns what the answers say, one answer for each of `probe_questions`.
StageArithmetic judge(std::string_view stage, std::span<const float> answers);

/// Returns why the proofs of `geometry` and `compute` (shaders/geometry.geom, candidates.glsl) may not hold with such
/// arithmetic. Empty if nothing speaks against them. The proofs need + - * that are rounded to nearest. They cover
/// contraction and flushed denormals, and they do not divide. Without a measured stage, nothing speaks for them;
/// `refusal` is then what the driver said.
std::string breaks_proofs(std::span<const StageArithmetic> stages, std::string_view refusal);

}  // namespace vestige
