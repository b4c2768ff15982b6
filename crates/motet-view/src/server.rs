//! Requests and answers.

use std::io::Read as _;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard};

use motet::{Error, Result};
use serde::de::DeserializeOwned;
use tiny_http::{Header, Method, Request, Response};

use crate::scene::Scene;

/// The longest request of a page, in bytes.
const MAX_BODY: u64 = 1 << 16;

/// A scene that pages on this machine can show and move.
///
/// The address contains a random word: other users and other pages of the browser do not know it.
pub struct Server {
    http: tiny_http::Server,
    address: SocketAddr,
    word: String,
    scene: Arc<Mutex<Scene>>,
}

type Answer = Response<std::io::Cursor<Vec<u8>>>;

impl Server {
    /// Listens on a port of this machine; 0 is any free one.
    ///
    /// # Errors
    /// When the port is taken.
    pub fn new(scene: Scene, port: u16) -> Result<Self> {
        let taken = |e: &dyn std::fmt::Display| {
            Error::options(format!("port {port} cannot be used: {e}"))
                .remedy("give another one, or 0 for any free one")
        };
        let http = tiny_http::Server::http((Ipv4Addr::LOCALHOST, port)).map_err(|e| taken(&e))?;
        let address = http.server_addr().to_ip().ok_or_else(|| taken(&"it has no address"))?;
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)
            .map_err(|e| Error::options(format!("there are no random numbers: {e}")))?;
        let word = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { http, address, word, scene: Arc::new(Mutex::new(scene)) })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://{}/{}/", self.address, self.word)
    }

    /// The scene, once no answer is being made.
    pub fn scene(&self) -> MutexGuard<'_, Scene> {
        self.scene.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Answers requests until [`Self::close`] is called.
    pub fn serve(&self) {
        for mut request in self.http.incoming_requests() {
            let answer = self.answer(&mut request);
            // A page that has gone does not matter.
            let _ = request.respond(answer);
        }
    }

    /// Ends [`Self::serve`].
    pub fn close(&self) {
        self.http.unblock();
    }

    fn answer(&self, request: &mut Request) -> Answer {
        if !self.names_this_machine(request) {
            return plain(404, "not found");
        }
        let path = request.url().strip_prefix(&format!("/{}/", self.word)).map(str::to_owned);
        let Some(path) = path else { return plain(404, "not found") };
        let response = self.response(request, &path);
        response.unwrap_or_else(|e| plain(400, &e.to_string()))
    }

    /// Whether a request names this machine: a page of another one could reach it under a name of its own.
    fn names_this_machine(&self, request: &Request) -> bool {
        let host = request.headers().iter().find(|header| header.field.equiv("Host"));
        let port = self.address.port();
        host.is_some_and(|host| {
            [format!("127.0.0.1:{port}"), format!("localhost:{port}")].contains(&host.value.to_string())
        })
    }

    fn response(&self, request: &mut Request, path: &str) -> Result<Answer> {
        let mut scene = self.scene();
        Ok(match (request.method(), path) {
            (Method::Get, "") => html(scene.page()?),
            (Method::Get, "page.html") => html(scene.offline_page()?),
            (Method::Get, "mesh.vtu") => typed("application/octet-stream", scene.file()?),
            (Method::Get, "facts") => json(scene.facts()?),
            (Method::Get, "update") => json(scene.update()),
            (Method::Post, "preview") => typed("application/octet-stream", scene.preview(&body(request)?)?),
            (Method::Post, "move") => json(scene.shift(&body(request)?)?),
            (Method::Post, "undo") => json(scene.undo()?),
            _ => plain(404, "not found"),
        })
    }
}

fn body<T: DeserializeOwned>(request: &mut Request) -> Result<T> {
    let mut text = Vec::new();
    let read = request.as_reader().take(MAX_BODY).read_to_end(&mut text);
    read.map_err(|e| Error::options(format!("the request cannot be read: {e}")))?;
    serde_json::from_slice(&text).map_err(|e| Error::options(format!("the request is not understood: {e}")))
}

fn html(text: String) -> Answer {
    typed("text/html; charset=utf-8", text.into_bytes())
}

fn json(text: String) -> Answer {
    typed("application/json", text.into_bytes())
}

fn plain(status: u16, text: &str) -> Answer {
    typed("text/plain; charset=utf-8", text.as_bytes().to_vec()).with_status_code(status)
}

fn typed(kind: &str, bytes: Vec<u8>) -> Answer {
    let headers =
        [("Content-Type", kind), ("X-Content-Type-Options", "nosniff"), ("Cache-Control", "no-store")];
    let headers = headers.into_iter().filter_map(|(name, value)| Header::from_bytes(name, value).ok());
    headers.fold(Response::from_data(bytes), Response::with_header)
}
