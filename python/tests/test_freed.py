"""Models give their memory back."""

import ctypes
import gc

import bryant
import pytest
from test_model import CART


class Heap(ctypes.Structure):
    """`struct mallinfo2` of the C library."""

    _fields_ = [
        (name, ctypes.c_size_t)
        for name in "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost".split()
    ]


def allocated():
    """Bytes that are allocated in the heap of this program."""
    gc.collect()
    heap = ctypes.CDLL(None).mallinfo2
    heap.restype = Heap
    found = heap()
    return found.uordblks + found.hblkhd


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "mallinfo2"), reason="only the GNU C library tells")
def test_nothing_of_a_model_stays_allocated():
    def use(number):
        m = bryant.load(CART.replace("push", f"push_{number:04}").replace("cart", f"cart-{number:04}"))
        assert m.accelerations([0.0], [0.0]) == [0.5]
        with pytest.raises(bryant.Error):
            m.accelerations([0.0], [0.0], [1000.0])
        del m

    for number in range(20):
        use(number)
    before = allocated()
    for number in range(20, 320):
        use(number)
    # Python's own tables may grow by a few kilobytes; each model has several of them
    assert allocated() - before < 100_000
