"""Models that name addresses of the network, which nobody may call."""

import threading
import urllib.request
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from mmrs_core.errors import PluginError
from mmrs_core.languages.metamodels.gathering import registry_of_files
from mmrs_core.languages.reading import read_model

HEAD = 'xmlns:zoo="urn:test:zoo" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'


@pytest.fixture
def server():
    """Return an HTTP server on this machine, and the paths that it was asked for."""
    asked = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):  # its name is the library's
            asked.append(self.path)
            self.send_response(200)
            self.end_headers()

        def log_message(self, *_):
            """Say nothing."""

    listening = HTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=listening.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{listening.server_port}", asked
    listening.shutdown()
    thread.join()
    listening.server_close()


def test_the_server_of_these_tests_notices_who_asks(server):
    address, asked = server
    with urllib.request.urlopen(f"{address}/far.xmi"):
        assert asked == ["/far.xmi"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('<zoo:Zoo {head}><star xsi:type="zoo:Lion" href="{address}/far.xmi#/"/></zoo:Zoo>', "XMI007"),
        ('<zoo:Zoo {head} favourites="zoo:Lion {address}/far.xmi#/"/>', "XMI007"),
        ('<zoo:Zoo {head}><animals xsi:type="zoo:Lion" href="{address}/far.xmi#/"/></zoo:Zoo>', "XMI007"),
        ('<far:Thing xmlns:far="{address}/far.ecore"/>', "XMI001"),
        ('<f:Thing xmlns:f="urn:f" {head} xsi:schemaLocation="urn:f {address}/f.ecore"/>', "XMI001"),
    ],
)
def test_no_model_makes_us_call_an_address(server, zoo, tmp_path, text, code):
    address, asked = server
    (tmp_path / "near.xmi").write_text(text.format(head=HEAD, address=address))
    assert [fault.code for fault in read_model(tmp_path / "near.xmi", zoo).diagnostics] == [code]
    assert asked == []


def test_no_metamodel_makes_us_call_an_address(server, tmp_path):
    address, asked = server
    (tmp_path / "near.ecore").write_text(
        '<ecore:EPackage xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" '
        'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" name="near" nsURI="urn:near" nsPrefix="near">'
        f'<eClassifiers xsi:type="ecore:EClass" name="A" eSuperTypes="{address}/far.ecore#//B"/>'
        "</ecore:EPackage>"
    )
    with pytest.raises(PluginError, match="needs the metamodel http"):
        registry_of_files([tmp_path / "near.ecore"], ())
    assert asked == []
