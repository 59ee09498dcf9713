//! A headless Chromium, driven through its DevTools protocol with real input events.
//!
//! The protocol runs over a pipe: JSON with a NUL at the end of each message, to file
//! descriptor 3 and from 4. A shell makes these of the standard ones, so that neither a
//! web socket nor `unsafe` is needed.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Names of browsers that know the protocol.
const NAMES: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];

/// How long an answer, or what a page does, may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// The first browser on `PATH`.
pub fn installed() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let mut found = NAMES
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    found.find(|file| file.is_file())
}

/// A browser with one page.
pub struct Browser {
    child: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    session: Option<String>,
    asked: u64,
    profile: PathBuf,
    /// What scripts complained of.
    pub complaints: Vec<String>,
}

impl Browser {
    /// Starts a browser; `name` tells its profile from others'.
    pub fn start(program: &Path, name: &str) -> Self {
        let folder = format!("triptych-page-{name}-{}", std::process::id());
        let profile = std::env::temp_dir().join(folder);
        // A container has no sandbox for it to use; it opens our own page alone.
        let script = "exec \"$0\" --headless --no-sandbox --disable-gpu --no-first-run \
            --remote-debugging-pipe --user-data-dir=\"$1\" about:blank \
            3<&0 4>&1 </dev/null >/dev/null 2>/dev/null";
        let mut child = Command::new("sh")
            .args(["-c", script])
            .args([program, &profile])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("there is a shell");
        let to = child.stdin.take().expect("it is piped");
        let from = BufReader::new(child.stdout.take().expect("it is piped"));
        let mut browser = Self {
            child,
            to,
            from: messages(from),
            session: None,
            asked: 0,
            profile,
            complaints: Vec::new(),
        };
        let page = browser.call("Target.createTarget", json!({"url": "about:blank"}));
        let attach = json!({"targetId": page["targetId"], "flatten": true});
        let attached = browser.call("Target.attachToTarget", attach);
        browser.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page.enable", "Runtime.enable", "Log.enable"] {
            browser.call(domain, json!({}));
        }
        browser
    }

    /// Calls a method of the protocol, and gives its result.
    #[track_caller]
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.asked += 1;
        let mut message = json!({"id": self.asked, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = session.as_str().into();
        }
        let bytes = format!("{message}\0");
        let sent = self.to.write_all(bytes.as_bytes());
        sent.and_then(|()| self.to.flush())
            .expect("the browser listens");
        loop {
            let message = self.from.recv_timeout(PATIENCE);
            let mut message = message.unwrap_or_else(|e| panic!("{method}: no answer: {e}"));
            if message["id"] == self.asked {
                assert!(message.get("error").is_none(), "{method}: {message}");
                return message["result"].take();
            }
            let complaint = ["Runtime.exceptionThrown", "Log.entryAdded"];
            if complaint.iter().any(|c| message["method"] == *c) {
                self.complaints.push(message["params"].to_string());
            }
        }
    }

    /// The value of an expression in the page.
    #[track_caller]
    pub fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({
            "expression": expression, "returnByValue": true, "awaitPromise": true,
        });
        let result = self.call("Runtime.evaluate", parameters);
        assert!(
            result.get("exceptionDetails").is_none(),
            "{expression}: {result}"
        );
        result["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    #[track_caller]
    pub fn wait(&mut self, expression: &str) {
        let start = Instant::now();
        while self.value(&format!("Boolean({expression})")) != json!(true) {
            assert!(start.elapsed() < PATIENCE, "never came true: {expression}");
            thread::sleep(Duration::from_millis(50));
        }
    }

    /// Opens a file in a window of this size.
    pub fn open(&mut self, page: &Path, [width, height]: [u32; 2]) {
        self.size([width, height]);
        // What scrolls smoothly is elsewhere by the time that it is clicked.
        let still = json!({"name": "prefers-reduced-motion", "value": "reduce"});
        self.call("Emulation.setEmulatedMedia", json!({ "features": [still] }));
        let url = format!("file://{}", page.display());
        self.call("Page.navigate", json!({ "url": url }));
        self.wait("location.href.startsWith('file:') && document.readyState === 'complete'");
    }

    /// Sets the window's size.
    pub fn size(&mut self, [width, height]: [u32; 2]) {
        let metrics = json!({
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500,
        });
        self.call("Emulation.setDeviceMetricsOverride", metrics);
    }

    /// Left, top, width and height of an element, brought into sight.
    #[track_caller]
    pub fn area(&mut self, selector: &str) -> [f64; 4] {
        let area = self.value(&format!(
            "(() => {{ const e = document.querySelector({selector:?}); \
             e.scrollIntoView({{block: 'center', behavior: 'instant'}}); \
             const b = e.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; }})()"
        ));
        [0, 1, 2, 3].map(|i| {
            area[i]
                .as_f64()
                .unwrap_or_else(|| panic!("{selector}: {area}"))
        })
    }

    /// Sends an event of the mouse at a place of the window.
    pub fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let buttons = u32::from(kind != "mouseReleased");
        let event = json!({
            "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1,
        });
        self.call("Input.dispatchMouseEvent", event);
    }

    /// Clicks at a place within an element, given in shares of its size.
    #[track_caller]
    pub fn click_at(&mut self, selector: &str, share: [f64; 2]) {
        let [left, top, width, height] = self.area(selector);
        let at = [left + share[0] * width, top + share[1] * height];
        self.mouse("mousePressed", at);
        self.mouse("mouseReleased", at);
    }

    /// Clicks on the middle of an element.
    #[track_caller]
    pub fn click(&mut self, selector: &str) {
        self.click_at(selector, [0.5, 0.5]);
    }

    /// Presses and releases a key, by the name that pages know it by.
    pub fn key(&mut self, key: &str) {
        let code = match key {
            "Enter" => 13,
            "Escape" => 27,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            _ => 0,
        };
        let mut event = json!({"type": "keyDown", "key": key, "windowsVirtualKeyCode": code});
        if key.chars().count() == 1 {
            event["text"] = key.into();
        }
        self.call("Input.dispatchKeyEvent", event.clone());
        event["type"] = "keyUp".into();
        self.call("Input.dispatchKeyEvent", event);
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // A browser or folder that stays behind fails no test.
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_dir_all(&self.profile);
    }
}

/// The messages of a pipe, read on a thread of their own, so that waiting for one ends.
fn messages(mut from: impl BufRead + Send + 'static) -> Receiver<Value> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        while from.read_until(0, &mut bytes).is_ok_and(|n| n > 0) {
            bytes.pop();
            let message = serde_json::from_slice(&bytes).unwrap_or_default();
            bytes.clear();
            if sender.send(message).is_err() {
                break;
            }
        }
    });
    receiver
}
