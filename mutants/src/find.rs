//! The places where a source file can be changed, and their replacements.

use std::ops::Range;

use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Block, Expr, ReturnType, Signature, Stmt, Type, UnOp};

/// Maximum number of source characters in a description.
const LONGEST: usize = 120;

/// The syntactic form of a mutant.
#[derive(Clone, Copy, PartialEq)]
pub enum Form {
    /// A replaced expression.
    Expression,
    /// An early return at the beginning of a body.
    Body,
    /// A removed statement.
    Left,
}

/// A place in a source file, with its possible replacements and a description of each.
pub struct Site {
    pub range: Range<usize>,
    pub form: Form,
    pub function: String,
    pub mutants: Vec<(String, String)>,
}

/// All sites of a source file, outer ones before those nested in them, and the files of its test modules.
pub fn find(source: &str) -> syn::Result<(Vec<Site>, Vec<String>)> {
    let file = syn::parse_file(source)?;
    let mut finder = Finder { source, names: Vec::new(), sites: Vec::new(), tests: Vec::new() };
    finder.visit_file(&file);
    Ok((finder.sites, finder.tests))
}

struct Finder<'a> {
    source: &'a str,
    /// The enclosing implemented type and functions.
    names: Vec<String>,
    sites: Vec<Site>,
    tests: Vec<String>,
}

impl Finder<'_> {
    fn text(&self, node: &impl Spanned) -> &str {
        &self.source[node.span().byte_range()]
    }

    /// The text of a node in one line, truncated.
    fn line(&self, node: &impl Spanned) -> String {
        let line = self.text(node).split_whitespace().collect::<Vec<_>>().join(" ");
        line.char_indices().nth(LONGEST).map_or(line.clone(), |(end, _)| format!("{}...", &line[..end]))
    }

    fn add(&mut self, range: Range<usize>, form: Form, mutants: Vec<(String, String)>) {
        if !mutants.is_empty() && !self.names.is_empty() {
            self.sites.push(Site { range, form, function: self.names.join("::"), mutants });
        }
    }

    fn function(&mut self, attributes: &[syn::Attribute], signature: &Signature, body: &Block) {
        if signature.constness.is_some() || is_for_tests(attributes) {
            return;
        }
        self.names.push(signature.ident.to_string());
        let begin = body.span().byte_range().start + 1;
        let values = if body.stmts.is_empty() { Vec::new() } else { self.values(&signature.output) };
        let mutants = values.into_iter().map(|v| (format!("return {v};"), format!("body -> {v}"))).collect();
        self.add(begin..begin, Form::Body, mutants);
        self.visit_block(body);
        self.names.pop();
    }

    /// Plausible values of a function's return type.
    fn values(&self, output: &ReturnType) -> Vec<String> {
        let ReturnType::Type(_, output) = output else { return vec!["()".into()] };
        let values: &[&str] = match &**output {
            Type::Path(path) => {
                let name = path.path.segments.last().map(|s| s.ident.to_string()).unwrap_or_default();
                match name.as_str() {
                    "bool" => &["true", "false"],
                    "u8" | "u16" | "u32" | "u64" | "usize" | "i8" | "i16" | "i32" | "i64" | "isize" => {
                        &["0", "1"]
                    }
                    "f32" | "f64" => &["0.0", "1.0"],
                    "Option" => &["None"],
                    "Vec" => &["Vec::new()"],
                    "Result" if self.text(output).contains("bool") => &["Ok(true)", "Ok(false)"],
                    "Result" => &["Ok(Default::default())"],
                    _ => &["Default::default()"],
                }
            }
            Type::Array(_) | Type::Tuple(_) => &["Default::default()"],
            _ => &[],
        };
        values.iter().map(|v| v.to_string()).collect()
    }

    fn expression(&self, expression: &Expr) -> Vec<(String, String)> {
        match expression {
            Expr::Binary(binary) if !has_let(expression) => {
                let [left, right] = [&binary.left, &binary.right].map(|side| self.text(side));
                let swaps = swaps(&binary.op).iter();
                swaps
                    .map(|op| (format!("({left}) {op} ({right})"), self.line(expression) + " -> " + op))
                    .collect()
            }
            Expr::Unary(unary) if !matches!(unary.op, UnOp::Deref(_)) => {
                let rest = self.text(&unary.expr);
                vec![(rest.into(), format!("{} -> {}", self.line(expression), self.line(&unary.expr)))]
            }
            _ => Vec::new(),
        }
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_for_tests(&item.attrs) {
            visit::visit_item_mod(self, item);
        } else if item.content.is_none() {
            self.tests.push(item.ident.to_string());
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        if !is_for_tests(&item.attrs) {
            self.names.push(self.line(&item.self_ty));
            visit::visit_item_impl(self, item);
            self.names.pop();
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.function(&item.attrs, &item.sig, &item.block);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.function(&item.attrs, &item.sig, &item.block);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(body) = &item.default {
            self.function(&item.attrs, &item.sig, body);
        }
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        if let Stmt::Expr(expression, Some(_)) = statement {
            let call = if let Expr::Try(inner) = expression { &*inner.expr } else { expression };
            if matches!(call, Expr::Call(_) | Expr::MethodCall(_)) {
                let what = self.line(expression) + "; -> left out";
                self.add(statement.span().byte_range(), Form::Left, vec![(String::new(), what)]);
            }
        }
        visit::visit_stmt(self, statement);
    }

    fn visit_expr(&mut self, expression: &'ast Expr) {
        let mutants = self.expression(expression);
        self.add(expression.span().byte_range(), Form::Expression, mutants);
        visit::visit_expr(self, expression);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        if let Some((_, guard)) = arm.guard.as_ref().filter(|(_, guard)| !has_let(guard)) {
            let what = |value: &str| (value.to_string(), format!("if {} -> {value}", self.line(guard)));
            let mutants = vec![what("true"), what("false")];
            self.add(guard.span().byte_range(), Form::Expression, mutants);
        }
        visit::visit_arm(self, arm);
    }

    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    // Patterns, types and constants cannot contain calls.
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast Type) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
}

fn swaps(op: &BinOp) -> &'static [&'static str] {
    match op {
        BinOp::Lt(_) => &["<=", ">"],
        BinOp::Le(_) => &["<", ">"],
        BinOp::Gt(_) => &[">=", "<"],
        BinOp::Ge(_) => &[">", "<"],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::Add(_) => &["-"],
        BinOp::Sub(_) => &["+"],
        BinOp::Mul(_) => &["/"],
        BinOp::Div(_) | BinOp::Rem(_) => &["*"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::BitAnd(_) | BinOp::BitXor(_) => &["|"],
        BinOp::BitOr(_) => &["&"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::AddAssign(_) => &["-="],
        BinOp::SubAssign(_) => &["+="],
        BinOp::MulAssign(_) => &["/="],
        BinOp::DivAssign(_) => &["*="],
        BinOp::BitAndAssign(_) => &["|="],
        BinOp::BitOrAssign(_) => &["&="],
        _ => &[],
    }
}

/// Whether an expression is a let chain, which is valid only after `if` and `while`.
fn has_let(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|a| {
        let is_test = |list: &syn::MetaList| a.path().is_ident("cfg") && list.tokens.to_string() == "test";
        a.path().is_ident("test") || a.meta.require_list().is_ok_and(is_test)
    })
}
