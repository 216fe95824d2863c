# Finds an interpreter with numpy and pybind11: Python3_EXECUTABLE if it is set, otherwise the first of python3 on the path and
# /usr/bin/python3. Sets AhmPython_FOUND, Python3_EXECUTABLE and the variables of pybind11.
set(_candidates ${Python3_EXECUTABLE})
if(NOT Python3_EXECUTABLE)
  find_program(_on_path python3)
  list(APPEND _candidates ${_on_path} /usr/bin/python3)
  unset(_on_path CACHE)
endif()
foreach(_candidate IN LISTS _candidates)
  execute_process(COMMAND ${_candidate} -c "import numpy, pybind11; print(pybind11.get_cmake_dir())"
    RESULT_VARIABLE _result OUTPUT_VARIABLE _pybind11_dir ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(_result EQUAL 0)
    set(Python3_EXECUTABLE ${_candidate})
    set(PYTHON_EXECUTABLE ${_candidate})
    find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
    find_package(pybind11 2.10 CONFIG QUIET HINTS ${_pybind11_dir})
    break()
  endif()
endforeach()
include(FindPackageHandleStandardArgs)

find_package_handle_standard_args(AhmPython REQUIRED_VARS pybind11_DIR Python3_Development.Module_FOUND
  REASON_FAILURE_MESSAGE "found no interpreter with numpy, pybind11 and headers (Debian: python3-numpy python3-pybind11 python3-dev)")
