// SPDX-License-Identifier: GPL-3.0-or-later
// For the C++ files of this folder: VTK silenced and listened to, exceptions turned into a status.
#ifndef VSC_IO_VTK_QUIET_HH
#define VSC_IO_VTK_QUIET_HH

#include <cctype>
#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

extern "C" {
#include "base/status.h"
}

namespace vsc {

// Takes VTK's messages instead of stderr and keeps the first error. That an array's stored range
// ("information") cannot be read, because it is infinite, is none.
class listener : public vtkOutputWindow {
public:
  static listener *New();
  vtkTypeMacro(listener, vtkOutputWindow);
  void DisplayText(const char *) override {}
  void DisplayWarningText(const char *) override {}
  void DisplayGenericWarningText(const char *) override {}
  void DisplayDebugText(const char *) override {}
  void DisplayErrorText(const char *text) override
  {
    if (text != nullptr && std::strstr(text, "InformationKey") != nullptr) return;
    failed = true;
    if (first.empty() && text != nullptr) first = text;
  }

  bool failed = false;
  std::string first;

protected:
  listener() = default;
};

inline listener *listener::New()
{
  VTK_STANDARD_NEW_BODY(listener);
}

inline std::mutex one_at_a_time;

// While it lives VTK is silent and what it had to say is heard. VTK has one output for all threads,
// so one call at a time is in here.
class silence {
public:
  silence() : lock(one_at_a_time), former(vtkOutputWindow::GetInstance()),
              displayed(vtkObject::GetGlobalWarningDisplay()),
              verbosity(vtkLogger::GetCurrentVerbosityCutoff())
  {
    vtkOutputWindow::SetInstance(heard);
    vtkObject::SetGlobalWarningDisplay(1);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~silence()
  {
    vtkLogger::SetStderrVerbosity(verbosity);
    vtkObject::SetGlobalWarningDisplay(displayed);
    vtkOutputWindow::SetInstance(former);
  }
  silence(const silence &) = delete;
  silence &operator=(const silence &) = delete;

  bool failed() const { return heard->failed; }

  // VTK's first error, without its source line, object and line breaks.
  std::string said() const
  {
    std::string text = heard->first;
    const size_t object = text.find("): ");
    if (object != std::string::npos) text.erase(0, object + 3);
    while (!text.empty() && std::isspace((unsigned char)text.back())) text.pop_back();
    return text.empty() ? "it breaks off" : text.substr(0, 200);
  }

private:
  std::lock_guard<std::mutex> lock;
  vtkSmartPointer<vtkOutputWindow> former;
  vtkNew<listener> heard;
  int displayed;
  vtkLogger::Verbosity verbosity;
};

inline vsc_status fail_size(const char *file, vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT,
                  "%s: announces more data than fits in memory: it is damaged, or too large for "
                  "this machine",
                  file);
}

// Runs `work` and turns exceptions into a status.
template <typename Work> vsc_status guarded(const char *file, vsc_error *error, Work work)
{
  try {
    return work();
  } catch (const std::bad_alloc &) {
    return fail_size(file, error);
  } catch (const std::length_error &) {
    return fail_size(file, error);
  } catch (const std::exception &problem) {
    return vsc_fail(error, VSC_SYSTEM, "%s: VTK failed: %s", file, problem.what());
  } catch (...) {
    return vsc_fail(error, VSC_SYSTEM, "%s: VTK failed without a reason", file);
  }
}

}  // namespace vsc

#endif
