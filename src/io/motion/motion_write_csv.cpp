#include "io/motion/motion_write.h"

#include <algorithm>
#include <initializer_list>

namespace hooke::io {

namespace {

constexpr const char* kHeader =
    "frame,time_s,object,point,x_m,y_m,z_m,vx_m_per_s,vy_m_per_s,vz_m_per_s,qx,qy,qz,qw,"
    "wx_rad_per_s,wy_rad_per_s,wz_rad_per_s,kinetic_J,potential_J\n";

/// Quotes a text where the format asks for it (RFC 4180).
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

void put_numbers(OutputSink& sink, std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    sink.put(",");
    sink.put_number(number, 9);
  }
}

void put_vector(OutputSink& sink, DVec3 v) {
  put_numbers(sink, {v.x, v.y, v.z});
}

void put_state(OutputSink& sink, const MotionState& state, bool is_body) {
  put_vector(sink, state.position);
  put_vector(sink, vector_cast<double>(state.velocity));
  if (!is_body) {
    sink.put(",,,,,,,,,\n");
    return;
  }
  const Quat q = state.rotation;
  for (const Real x : {q.x, q.y, q.z, q.w}) put_numbers(sink, {static_cast<double>(x)});
  put_vector(sink, vector_cast<double>(state.angular_velocity));
  put_numbers(sink, {state.energy.kinetic, state.energy.potential});
  sink.put("\n");
}

}  // namespace

Result<void> write_csv_motion(const MotionJob& job) {
  const MotionData& data = job.data;
  OutputSink sink(job.path);
  sink.put(kHeader);
  for (std::size_t frame = 0; frame < data.frames.size() && !sink.error(); ++frame) {
    const std::string number = std::to_string(frame) + ",";
    for (std::size_t i = 0; i < data.objects.size(); ++i) {
      if (frame < data.tracks[i].first || frame >= data.tracks[i].end) continue;
      const bool is_body = data.objects[i].kind == MotionObject::Kind::kBody;
      const auto begin_row = [&](const std::string& point) {
        sink.put(number);
        sink.put_number(data.time(frame), 9);
        sink.put("," + quoted(data.objects[i].name) + "," + point);
      };
      begin_row("");
      put_state(sink, data.state(i, frame), is_body);
      if (is_body || !job.options.with_points) continue;
      const std::vector<Vec3> points = data.points(i, frame);
      for (std::size_t p = 0; p < points.size(); ++p) {
        begin_row(std::to_string(p));
        put_vector(sink, vector_cast<double>(points[p]));
        sink.put(",,,,,,,,,,,,\n");
      }
    }
    job.show(static_cast<double>(frame + 1) / static_cast<double>(data.frames.size()));
  }
  return sink.finish(job.summary);
}

}  // namespace hooke::io
