"""Each thread gets its own messages of VTK."""

import logging
from concurrent.futures import ThreadPoolExecutor

import pytest
from pyvista.core.utilities.observers import Observer
from vtkmodules.vtkCommonCore import vtkOutputWindow

from vizlight import files
from vizlight.vtk import messages


def test_what_vtk_says_is_told_apart_by_thread(tmp_path, capfd):
    bad = tmp_path / "bad.vtp"
    bad.write_text("no mesh")
    window = vtkOutputWindow.GetInstance()

    def say():
        vtkOutputWindow.GetInstance().DisplayErrorText("said elsewhere\n")

    with messages.captured_errors() as errors, ThreadPoolExecutor(1) as pool:
        with messages.captured_errors() as inner:
            vtkOutputWindow.GetInstance().DisplayErrorText("said within\n")
        pool.submit(say).result()
        with pytest.raises(files.FileError, match="Error parsing XML"):
            pool.submit(files.read, bad).result()
        vtkOutputWindow.GetInstance().DisplayWarningText("said here\n")
    assert (errors, inner) == (["said here"], ["said within"])
    assert capfd.readouterr().err == "said elsewhere\n"
    assert vtkOutputWindow.GetInstance() is window


def test_what_pyvista_repeats_is_no_record(caplog):
    with messages.captured_errors():
        Observer().log_message("ERROR", "of VTK")
        logging.getLogger("mine").error("another")
        with ThreadPoolExecutor(1) as pool:
            pool.submit(Observer().log_message, "ERROR", "elsewhere").result()
    Observer().log_message("WARNING", "after")
    assert [record.message for record in caplog.records] == ["another", "elsewhere", "after"]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (UnicodeDecodeError("utf-8", b"a\xb5", 1, 2, "x"), "the byte 0xb5, which is not of UTF-8"),
        (KeyError(5), "its parts do not fit together, by KeyError: 5"),
        (AssertionError(), "its parts do not fit together, by AssertionError"),
        (MemoryError(), "it asks for more memory than there is"),
        (OSError(-101, "NetCDF: HDF error"), "NetCDF: HDF error"),
        (ValueError("3 of 4\nrows"), "3 of 4"),
        (ValueError("could not convert string to float: 'x'"), "should be: 'x'"),
    ],
)
def test_errors_of_readers_are_words(error, words):
    assert messages.reason(error).endswith(words)
