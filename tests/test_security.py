"""What SECURITY.md promises, a test for each line; laws of files are in `test_own_law`."""

import re
import socket

import psutil
import pytest

from stiction.cli.sweep import engine
from stiction.errors import StictionError
from stiction.study.cluster import Processes


def listening(*_):
    """Return where this process listens."""

    found = psutil.Process().net_connections("inet")
    return [tuple(each.laddr) for each in found if each.status == psutil.CONN_LISTEN]


def answer(address):
    """Return what comes back from a port to one who has no certificate."""
    with socket.create_connection(address) as line:
        line.sendall(b"GET /status HTTP/1.0\r\n\r\n")
        try:
            with line.makefile("rb") as file:
                return file.read()
        except ConnectionResetError:
            return b""


def test_workers_listen_to_this_machine_and_to_their_own_client_alone():
    ours = set(listening())
    at_work = Processes(1).results(lambda *_: listening(), [0])
    doors = {*next(at_work), *listening()} - ours
    assert len(doors) >= 3  # scheduler, nanny, worker
    assert {host for host, _ in doors} == {"127.0.0.1"}
    # an alert of TLS (RFC 8446, 6), nothing, or a server of pages that has none
    answers = [answer(door) for door in doors]
    told = [a for a in answers if a and a[0] != 21 and not re.match(rb"HTTP/1.\d 404", a)]
    assert told == []
    at_work.close()


def test_the_dashboard_is_shown_where_it_is_asked_for():
    assert engine(None, 2, None) == Processes(2, dashboard=False)
    assert engine(None, 2, None, True) == Processes(2, dashboard=True)
    with pytest.raises(StictionError, match="--dashboard is of --workers"):
        engine(2, None, None, True)
