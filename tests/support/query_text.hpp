#pragma once

#include <string>

#include "analysis/stress/query_file.hpp"

namespace vestige::test {

inline const std::string kSegmentHeader = "source,query,gt,float_exact,px,py,pz,qx,qy,qz,ax,ay,az,bx,by,bz,cx,cy,cz\n";

/// A query in which a point falls from z = 1 to z = -1 through a triangle at rest.
inline const std::string kFalls =
    "1,1,1,1,1,1,1\n0,1,0,1,0,1,1\n4,1,0,1,0,1,1\n0,1,4,1,0,1,1\n"
    "1,1,1,1,-1,1,1\n0,1,0,1,0,1,1\n4,1,0,1,0,1,1\n0,1,4,1,0,1,1\n";

inline const std::string kFallsAsSegment =
    "falls,0,1,1,0x1p+0,0x1p+0,0x1p+0,0x1p+0,0x1p+0,-0x1p+0,0x0p+0,0x0p+0,0x0p+0,0x1p+2,0x0p+0,0x0p+0,0x0p+0,0x1p+2,"
    "0x0p+0\n";

inline QueryFile parse(const std::string& text, Inexact inexact = Inexact::kRefuse) {
  return parse_queries(text, "q.csv", inexact);
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace vestige::test
