//! Lines, rectangles and text of an SVG file.

/// Text and axes: a class, as what follows, because their colours are others on a dark page.
pub const INK: &str = "ink";
/// Lines across a panel.
pub const PALE: &str = "pale";
/// What is only there to compare with.
pub const GREY: &str = "grey";

/// The colours of these classes, and of the page, in light and in dark.
const STYLE: &str = "\
.page { fill: #ffffff } text { fill: #1f2933 }
.ink { stroke: #1f2933 } .pale { stroke: #e3e8ee } .grey { stroke: #7b8794 }
@media (prefers-color-scheme: dark) {
.page { fill: #0d1117 } text { fill: #e6edf3 }
.ink { stroke: #e6edf3 } .pale { stroke: #2b323b } .grey { stroke: #8b949e }
}
";

/// Colours of engines, in their order: apart from each other for the colour-blind, too (Okabe and Ito 2008).
const COLORS: [&str; 6] = ["#d55e00", "#56b4e9", "#009e73", "#cc79a7", "#e69f00", "#0072b2"];

/// The colour of engine `index`.
pub fn color(index: usize) -> &'static str {
    COLORS[index % COLORS.len()]
}

/// How text lies to its place.
#[derive(Clone, Copy)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// A point of the picture, pixels from its left and its upper edge.
#[derive(Clone, Copy)]
pub struct Place(pub f64, pub f64);

/// A picture in the making.
pub struct Drawing(String);

impl Drawing {
    /// An empty one.
    pub fn new() -> Self {
        Self(String::new())
    }

    /// The file.
    pub fn finish(self, width: f64, height: f64) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" \
             font-family=\"system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', Arial, sans-serif\">\n\
             <style>\n{STYLE}</style>\n<rect class=\"page\" width=\"100%\" height=\"100%\" rx=\"8\"/>\n{}</svg>\n",
            self.0
        )
    }

    /// A straight line, one pixel wide.
    pub fn line(&mut self, Place(x1, y1): Place, Place(x2, y2): Place, class: &str) {
        self.0 += &format!(
            "<line class=\"{class}\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>\n"
        );
    }

    /// A line through points with a dot at each.
    pub fn curve(&mut self, places: &[Place], color: &str) {
        let points: Vec<String> = places.iter().map(|Place(x, y)| format!("{x:.1},{y:.1}")).collect();
        self.0 += &format!(
            "<polyline class=\"curve\" points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>\n",
            points.join(" ")
        );
        for place in places {
            self.dot(*place, color);
        }
    }

    fn dot(&mut self, Place(x, y): Place, color: &str) {
        self.0 += &format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{color}\"/>\n");
    }

    /// A short sample of a curve's line, for a key.
    pub fn sample(&mut self, Place(x, y): Place, color: &str) {
        self.0 += &format!(
            "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\" stroke=\"{color}\" \
             stroke-width=\"2\"/>\n",
            x + 28.0
        );
    }

    /// A bar to the right and downwards from a place.
    pub fn bar(&mut self, Place(left, top): Place, [width, height]: [f64; 2], color: &str) {
        self.0 += &format!(
            "<rect class=\"bar\" x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.2}\" height=\"{height:.1}\" fill=\"{color}\"/>\n"
        );
    }

    /// The picture's title.
    pub fn title(&mut self, place: Place, text: &str) {
        self.write(place, Anchor::Start, "font-size=\"18\" font-weight=\"600\"", text);
    }

    /// A panel's title, and behind it what it is about, less loud.
    pub fn heading(&mut self, Place(x, y): Place, text: &str, note: &str) {
        let [text, note] = [text, note].map(escape);
        self.0 += &format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"14\" font-weight=\"600\">{text}\
             <tspan dx=\"8\" font-size=\"11.5\" font-weight=\"400\">{note}</tspan></text>\n"
        );
    }

    /// Text to read.
    pub fn text(&mut self, place: Place, anchor: Anchor, text: &str) {
        self.write(place, anchor, "font-size=\"13\"", text);
    }

    /// Numbers along axes, and what stands at the foot.
    pub fn small(&mut self, place: Place, anchor: Anchor, text: &str) {
        self.write(place, anchor, "font-size=\"11.5\"", text);
    }

    fn write(&mut self, Place(x, y): Place, anchor: Anchor, font: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        self.0 += &format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" {font}>{text}</text>\n");
    }
}

/// Text that is no markup.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
